#pragma once

#include "core/bvh/bvh.h"
#include "kernels/layouts/layout.h"

#include <cstdint>
#include <string>

namespace tetrace {

/// The largest coordinate, in domain units, for which a BVH is built: the same limit as for rays and walks
/// (core/base/exact.h).
inline constexpr float max_bvh_coordinate = 64;

/// A BVH and how it was built.
struct BuiltBvh {
    Bvh bvh;
    double build_s = 0;
    std::uint64_t spatial_splits = 0; ///< references in addition to one per triangle
    std::string fall_back; ///< why it is not the heuristic's tree, but triangles halved by number; empty if it is
};

/// Builds a binary BVH by the surface area heuristic with spatial splits, with Embree; leaves have 1 to 4 triangles,
/// and at most BVH2_STACK inner nodes are above a leaf: if the heuristic would have more, triangles are halved by
/// number (build_balanced_bvh()), and fall_back says so. The tree does not depend on the number of threads.
/// mesh: in domain units. threads: of Embree; 0: all. max_depth: in place of BVH2_STACK.
/// Throws Error{invalid_input} for a mesh without triangles, or with a corner that is missing, not finite or larger
/// than max_bvh_coordinate; Error{unsupported} where Embree runs out of memory.
/// Source: Stich, Friedrich, Dietrich 2009, Spatial Splits in Bounding Volume Hierarchies; Embree's rtcBuildBVH.
[[nodiscard]] BuiltBvh build_bvh(const TriangleMesh& mesh, unsigned threads = 0, std::uint32_t max_depth = BVH2_STACK);

} // namespace tetrace
