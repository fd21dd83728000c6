#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/pack/packed_scene.h"

namespace tetrace {

/// Builds a mesh's BVH and packs it: build_bvh() and pack_bvh(), and what they throw.
/// layout: bvh2 or cwbvh. threads: of the build; 0: all.
[[nodiscard]] PackedScene make_bvh_scene(const TriangleMesh& mesh, Layout layout, unsigned threads = 0);

} // namespace tetrace
