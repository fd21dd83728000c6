#pragma once

#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// Pairs of triangles that meet outside the vertex or edge that they share; overlap in a plane counts.
struct SelfIntersections {
    std::uint64_t count = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        first; ///< the first pairs in lexicographic order, lower index first
};

/// Exact. The mesh has no degenerate and no duplicate triangles (clean_up). At most `listed` pairs are named.
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleMesh& mesh, std::size_t listed = 5);

/// Sentences for a person: the count, the pairs with their corners in mesh units (placed coordinates times
/// 2^-scale_exponent), and what to do.
[[nodiscard]] std::string describe(const SelfIntersections& found, const TriangleMesh& mesh, int scale_exponent);

} // namespace tetrace
