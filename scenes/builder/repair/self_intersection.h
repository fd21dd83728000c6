#pragma once

#include "core/mesh/scene.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// Two triangles of a mesh, the lower number first.
using TrianglePair = std::pair<std::uint32_t, std::uint32_t>;

/// Pairs of triangles that meet outside the vertex or edge that they share; overlap in a plane counts.
struct SelfIntersections {
    std::uint64_t count = 0;
    std::vector<TrianglePair> first; ///< the first pairs in lexicographic order
};

/// Exact. The mesh is free of degenerate and duplicate triangles (clean_up). At most `listed` pairs are named.
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleMesh& mesh, std::size_t listed = 5);

/// All such pairs, in lexicographic order.
[[nodiscard]] std::vector<TrianglePair> intersecting_pairs(const TriangleMesh& mesh);

/// Of these, the pairs with one or two new triangles. is_new: of each triangle.
[[nodiscard]] std::vector<TrianglePair> intersecting_pairs(const TriangleMesh& mesh, const std::vector<bool>& is_new);

/// Sentences for a person: the count, the pairs with their numbers in the source and their corners in the
/// coordinates of the mesh's file, and what to do.
[[nodiscard]] std::string describe(const SelfIntersections& found, const Scene& scene);

} // namespace tetrace
