#pragma once

#include "backends/embree/bvh_builder.h"
#include "core/pack/pack_bvh.h"
#include "core/rays/ray_set.h"
#include "kernels/layouts/layout.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

namespace tetrace::test {

/// Builds a mesh's BVH and packs it: build_bvh() and pack_bvh(), and what they throw.
/// layout: bvh2, bvh4 or cwbvh.
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

/// A mesh, its BVH, and rays that fill their stacks: to the last entry that the tree needs, more than the entries that
/// GPUs keep in a group's memory.
struct FullStacks {
    TriangleMesh mesh;
    PackedScene packed;
    RaySet rays;

    explicit FullStacks(Layout layout)
    {
        rays.kind = RayKind::random;
        rays.width = TILE_WIDTH;
        layout == Layout::bvh2 ? make_chain() : make_nest(layout);
    }

private:
    static constexpr std::uint32_t ray_count = 64 * TILE_WIDTH;

    void make_chain()
    {
        const DeepTree deep(BVH2_STACK);
        mesh = deep.mesh;
        packed = pack_bvh(mesh, deep.bvh, Layout::bvh2);
        Random random(19);
        for (std::uint32_t i = 0; i < ray_count; ++i)
            add_ray({coarse(random.between(-0.25f, 0.25f)), coarse(random.between(-0.25f, 0.25f)), 1},
                    {coarse(random.between(-0.5f, 0.5f)), coarse(random.between(-0.5f, 0.5f)), -0.75f});
    }

    // From the side of the smallest groups, so that the larger ones wait: rays that reach those, and rays through the
    // point that the groups shrink towards, which enter the boxes of all and end at a small one.
    void make_nest(Layout layout)
    {
        mesh = nested_groups(1, 32, 20);
        for (Float3& vertex : mesh.vertices)
            vertex = snap_to_grid(vertex);
        packed = make_bvh_scene(mesh, layout);
        Random random(20);
        for (std::uint32_t i = 0; i < ray_count; ++i)
            add_ray({coarse(random.between(-0.125f, 0)), coarse(random.between(-0.125f, 0)), -0.0625f},
                    {coarse(random.between(0.5f, 1)), coarse(random.unit()), coarse(random.unit())});
        for (std::uint32_t i = 0; i < ray_count / 2; ++i) {
            const Float3 to = {coarse(random.between(0.5f, 1)), coarse(random.between(0, 0.5f)),
                               coarse(random.between(0, 0.5f))};
            add_ray({to.x / -8, to.y / -8, to.z / -8}, to);
        }
    }

    static float coarse(float x) { return std::floor(x * 1024) / 1024; }

    void add_ray(Float3 from, Float3 to)
    {
        const auto number = static_cast<std::uint32_t>(rays.rays.size());
        rays.rays.push_back(
            {from, {to.x - from.x, to.y - from.y, to.z - from.z}, NO_END, NO_HALF_FACE, FREE_FACE, number});
    }
};

/// 0, 1, ..., count - 1.
[[nodiscard]] inline std::vector<std::uint32_t> counted_up_to(std::size_t count)
{
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
}

} // namespace tetrace::test
