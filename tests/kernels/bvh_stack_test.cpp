// How many entries of its stack a ray touches, counted in the kernels themselves: all their entries are where a group's
// memory would be, and that counts.
#include "core/device/backend.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace {

std::array<std::uint32_t, 256> stack_words;
std::size_t touched_words = 0;

std::uint32_t& touched_word(std::size_t index)
{
    touched_words = std::max(touched_words, index + 1);
    return stack_words.at(index);
}

} // namespace

#define STACK_TOP (BVH4_STACK + 1u) // the most of all layouts
#define GROUP_WORDS(count)
#define GROUP_WORD(scene, index) touched_word(index)
#include "tests/support/bvh_kernels.h"

#include "tests/support/bvh_scene.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Entries that the worst of these rays touches.
class TouchedEntries {
public:
    explicit TouchedEntries(const PackedScene& packed) : packed_(packed) {}

    void trace(Float3 from, Float3 to)
    {
        const bvh::Ray ray = bvh::make_ray(bvh::to_vec3(from), {to.x - from.x, to.y - from.y, to.z - from.z});
        touched_words = 0;
        static_cast<void>(bvh::trace_packed(packed_, {}, ray, NO_END));
        most_ = std::max(most_, static_cast<std::uint32_t>(touched_words / STACK_ENTRY_WORDS));
    }
    [[nodiscard]] std::uint32_t most() const { return most_; }

private:
    const PackedScene& packed_;
    std::uint32_t most_ = 0;
};

class BvhStack : public testing::TestWithParam<std::tuple<MeshRow, Layout>> {};

} // namespace

TEST_P(BvhStack, no_ray_touches_more_entries_than_the_packed_scene_says)
{
    const auto& [mesh, layout] = GetParam();
    const PackedScene packed = make_bvh_scene(mesh.make(), layout);
    TouchedEntries touched(packed);
    Random random(31);
    for (int i = 0; i < 20'000; ++i)
        touched.trace(random.point(-1, 1), random.point(-0.5f, 0.5f));
    EXPECT_LE(touched.most(), packed.stack_entries);
}

INSTANTIATE_TEST_SUITE_P(each, BvhStack,
                         testing::Combine(testing::ValuesIn(meshes_to_pack()),
                                          testing::Values(Layout::bvh2, Layout::bvh4, Layout::cwbvh)),
                         [](const auto& tested) {
                             return std::string(std::get<0>(tested.param).name) + "_" +
                                    std::string(name_of(std::get<1>(tested.param)));
                         });

TEST(BvhStack, rays_through_every_box_of_a_deep_tree_touch_as_many_entries_as_the_packed_scene_says)
{
    for (const std::uint32_t depth : {1u, 2u, 17u, BVH2_STACK}) {
        const DeepTree deep(depth);
        const PackedScene packed = pack_bvh(deep.mesh, deep.bvh, Layout::bvh2);
        TouchedEntries touched(packed);
        touched.trace({0, 0, 1}, {0.25f, 0.25f, -0.75f});
        EXPECT_EQ(touched.most(), depth + 1) << "BVH2_END and a child at each depth";
        EXPECT_EQ(packed.stack_entries, depth + 1);
    }
}

TEST(BvhStack, rays_through_every_box_of_a_deep_bvh4_touch_as_many_entries_as_the_packed_scene_says)
{
    for (const std::uint32_t depth : {1u, 2u, 17u, BVH2_STACK}) {
        // Triangles above one another. Each leaf is below all leaves that are deeper in the tree.
        TriangleMesh mesh;
        Bvh bvh = chain(depth, {});
        for (std::uint32_t i = 0; i <= depth; ++i) {
            const float z = static_cast<float>(i) / 128;
            add_triangle(mesh, {-0.5f, -0.5f, z}, {0.5f, -0.5f, z}, {0, 0.5f, z});
            bvh.references[i] = i;
        }
        for (std::size_t node = bvh.nodes.size(); node-- > 0;) {
            BvhNode& at = bvh.nodes[node];
            at.box = at.count > 0 ? triangle_box(mesh, at.first)
                                  : merged(bvh.nodes[at.child[0]].box, bvh.nodes[at.child[1]].box);
        }
        ASSERT_EQ(find_defect(bvh, mesh), std::nullopt);
        const PackedScene packed = pack_bvh(mesh, bvh, Layout::bvh4);
        TouchedEntries touched(packed);
        touched.trace({0, 0, 1}, {0.0625f, 0.0625f, -0.75f});
        EXPECT_EQ(touched.most(), packed.stack_entries);
        EXPECT_GT(packed.stack_entries, depth / 2);
    }
}

TEST(BvhStack, rays_that_fill_cwbvhs_stack_touch_as_many_entries_as_the_packed_scene_says)
{
    const FullStacks full(Layout::cwbvh);
    TouchedEntries touched(full.packed);
    for (const GivenRay& ray : full.rays.rays)
        touched.trace(ray.origin,
                      {ray.origin.x + ray.direction.x, ray.origin.y + ray.direction.y, ray.origin.z + ray.direction.z});
    EXPECT_GT(touched.most(), STACK_TOP_OF_GPUS);
    EXPECT_EQ(touched.most(), full.packed.stack_entries);
}
