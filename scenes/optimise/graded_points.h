#pragma once

#include "core/mesh/domain.h"

#include <vector>

namespace tetrace {

/// Points in the domain, dense near the mesh and sparse far from it, to begin an optimisation with: the centres, moved
/// a little, of the empty leaves of an octree over the domain whose cells are cut while a triangle is near. The
/// largest cells have 1/4 of the domain's size, the smallest about the length of the mesh's edges, within 1/32 and
/// 1/256. None is in a cell that triangles part from the domain's boundary. The same points on every machine. Time and
/// memory: linear in the triangles, in their area over that of the smallest cells, and in the number of those (34 MB).
[[nodiscard]] std::vector<Float3> graded_points(const TriangleMesh& mesh, const Domain& domain);

} // namespace tetrace
