#pragma once

#include "backends/embree/bvh_builder.h"
#include "core/pack/pack_bvh.h"

namespace tetrace::test {

/// Builds a mesh's BVH and packs it: build_bvh() and pack_bvh(), and what they throw.
/// layout: bvh2 or cwbvh.
[[nodiscard]] inline PackedScene make_bvh_scene(const TriangleMesh& mesh, Layout layout)
{
    return pack_bvh(mesh, build_bvh(mesh).bvh, layout);
}

} // namespace tetrace::test
