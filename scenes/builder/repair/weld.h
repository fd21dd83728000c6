#pragma once

#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// One pass that merges what is nearer than the tolerance, of the chosen triangles: vertices within half of it are
/// merged, edges that pass each other and an edge that crosses a triangle get a common vertex, and every edge and
/// triangle is cut at the vertices near it. So near layers become one, and triangles that cross share vertices and
/// edges. In double arithmetic: whether triangles cross after it is for intersecting_pairs() to say. mesh: without
/// degenerate triangles; afterwards it may have some, and duplicates. origins, chosen: as many as triangles; pieces
/// have their triangle's origin. Nothing moves by more than 1.5 times the tolerance: a vertex by half of it, and then
/// faces and edges to vertices near them.
void weld(TriangleMesh& mesh, std::vector<std::uint32_t>& origins, double tolerance, std::vector<bool> chosen);

} // namespace tetrace
