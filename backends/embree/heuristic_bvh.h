#pragma once

#include "core/bvh/bvh.h"

#include <cstdint>
#include <optional>
#include <string>

namespace tetrace {

/// A BVH by the surface area heuristic, or why there is none.
struct HeuristicBvh {
    std::optional<Bvh> bvh;
    std::string why_not;
};

/// The part of build_bvh() that Embree does; a small build has none. mesh: checked. Throws Error{unsupported} where
/// Embree runs out of memory.
[[nodiscard]] HeuristicBvh build_heuristic_bvh(const TriangleMesh& mesh, unsigned threads, std::uint32_t max_depth);

} // namespace tetrace
