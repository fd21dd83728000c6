#pragma once

#include "core/bvh/bvh.h"

#include <cstdint>

namespace tetrace {

/// The largest coordinate, in domain units, for which a BVH is built: the same limit as for rays and walks
/// (core/base/exact.h).
inline constexpr float largest_bvh_coordinate = 64;

/// A BVH and how it was built.
struct BuiltBvh {
    Bvh bvh;
    double build_s = 0;
    std::uint64_t spatial_splits = 0; ///< references beyond one a triangle
    bool balanced = false;            ///< triangles halved by number: the heuristic's tree would have been too deep
};

/// Builds a binary BVH by the surface area heuristic with spatial splits, with Embree; leaves have 1 to 4 triangles,
/// and at most BVH2_STACK inner nodes stand above a leaf. The tree does not
/// depend on the number of threads.
/// mesh: in domain units. threads: of Embree; 0: all.
/// Throws Error{invalid_input} for a mesh without triangles, or with a corner that is missing, not finite or beyond
/// largest_bvh_coordinate; Error{unsupported} where Embree runs out of memory.
/// Source: Stich, Friedrich, Dietrich 2009, Spatial Splits in Bounding Volume Hierarchies; Embree's rtcBuildBVH.
[[nodiscard]] BuiltBvh build_bvh(const TriangleMesh& mesh, unsigned threads = 0);

} // namespace tetrace
