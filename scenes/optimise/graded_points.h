#pragma once

#include "core/mesh/domain.h"

#include <vector>

namespace tetrace {

/// Points in the domain, dense near the mesh and sparse far from it, to begin an optimisation with: the centres, moved
/// a little, of the empty leaves of an octree over the domain whose cells are cut while a triangle is near. Cells have
/// 1/4 to 1/64 of the domain's size. None is in a cell that triangles part from the domain's boundary. The same points
/// on every machine. Time and memory: linear in the triangles, and in their area over that of the smallest cells.
[[nodiscard]] std::vector<Float3> graded_points(const TriangleMesh& mesh, const Domain& domain);

} // namespace tetrace
