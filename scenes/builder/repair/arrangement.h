// repair/: triangles that are degenerate, twice there, or cross others: found, dropped, and cut
#pragma once

#include "scenes/builder/repair/self_intersection.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// A mesh whose triangles are cut along their intersections.
struct CutMesh {
    TriangleMesh mesh;                  ///< the pieces, or the triangle itself, in the order of the triangles
    std::vector<std::uint32_t> parents; ///< of each: the triangle that it is, or is a piece of
};

/// Cuts the triangles of these pairs along what they share: points, segments, or polygons where they overlap in a
/// plane. Exact: each is the constrained Delaunay triangulation of its corners and of what it shares, and three
/// triangles that meet in a point have that very point. Then each vertex is rounded to a float on the grid of
/// core/base/exact.h, so that pieces may be degenerate, be duplicates, or cross others anew. Vertices are not merged;
/// pieces are turned as their triangles are. No triangle of the pairs is degenerate.
[[nodiscard]] CutMesh cut_along_intersections(const TriangleMesh& mesh, std::span<const TrianglePair> pairs);

} // namespace tetrace
