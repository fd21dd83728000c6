#pragma once

#include "core/base/vec.h"
#include "scenes/builder/own_tets.h"

#include <vector>

namespace tetrace {

/// The Delaunay tetrahedralization of points, by exact predicates: positive tets, sorted by their corners, so that
/// their order is the same with every version of CGAL. Of points at the same place only one is a corner. Empty if all
/// points lie in a plane.
[[nodiscard]] std::vector<TetCorners> delaunay_tets(const std::vector<Float3>& points);

} // namespace tetrace
