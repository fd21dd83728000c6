#pragma once

#include "core/bvh/bvh.h"

namespace tetrace {

/// A BVH of the least depth: triangles are halved by their boxes' centres along the longest axis until at most 4 are
/// left. It traces more slowly than a tree by the surface area heuristic, and serves meshes for which that is too deep.
/// mesh: at least one triangle, finite.
[[nodiscard]] Bvh build_balanced_bvh(const TriangleMesh& mesh);

} // namespace tetrace
