#pragma once

#include "core/mesh/triangle_mesh.h"
#include "scenes/builder/raw_tets.h"

#include <vector>

namespace tetrace {

/// As run_tetgen(), without orders, by the conforming constrained Delaunay triangulation of CGAL 6.1 and later. Throws
/// BuilderFailure{BUILDER_TETGEN_REFUSED} where it fails, and at once where this program is built with an older CGAL.
[[nodiscard]] RawTets run_cgal(const TriangleMesh& mesh, const TriangleMesh& surface,
                               const std::vector<Float3>& points);

} // namespace tetrace
