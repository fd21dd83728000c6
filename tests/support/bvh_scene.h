#pragma once

#include "backends/embree/bvh_builder.h"
#include "core/pack/pack_bvh.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"

#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

namespace tetrace::test {

/// Builds a mesh's BVH and packs it: build_bvh() and pack_bvh(), and what they throw.
/// layout: bvh2 or cwbvh.
[[nodiscard]] inline PackedScene make_bvh_scene(const TriangleMesh& mesh, Layout layout)
{
    return pack_bvh(mesh, build_bvh(mesh).bvh, layout);
}

/// A mesh that a layout of BVHs is tested with.
struct MeshRow {
    const char* name;
    std::function<TriangleMesh()> make;
};

[[nodiscard]] inline std::vector<MeshRow> meshes_to_pack()
{
    return {{"surface", [] { return make_cubes(6).mesh; }},
            {"needles", [] { return needles(300); }},
            {"one_triangle", [] { return identical_triangles(1); }},
            {"same_triangles", [] { return identical_triangles(500); }},
            {"deep", [] { return nested_groups(2, 30, 300); }}};
}

/// 0, 1, ..., count - 1.
[[nodiscard]] inline std::vector<std::uint32_t> counted_up_to(std::size_t count)
{
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
}

} // namespace tetrace::test
