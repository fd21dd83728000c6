#pragma once

#include "core/bvh/bvh.h"

namespace tetrace {

/// The same BVH with each leaf split, at the least surface area, until leaves have one triangle. References are in the
/// order of the leaves, so the references below a node are contiguous.
/// bvh: valid for this mesh (see find_defect).
[[nodiscard]] Bvh with_single_leaves(const TriangleMesh& mesh, const Bvh& bvh);

} // namespace tetrace
