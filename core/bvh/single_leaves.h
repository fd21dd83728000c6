#pragma once

#include "core/bvh/bvh.h"

namespace tetrace {

/// The same BVH with each leaf split until its leaves have one triangle, at the least surface area; references stand in
/// the order of the leaves, so those below any node stand together.
/// bvh: of this mesh, valid (see find_defect).
[[nodiscard]] Bvh with_single_leaves(const TriangleMesh& mesh, const Bvh& bvh);

} // namespace tetrace
