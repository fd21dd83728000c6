#include "core/pack/pack_bvh.h"

#include "backends/embree/bvh_builder.h"
#include "kernels/layouts/layout.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"
#include "tests/support/bvh_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A node's words again.
struct Bvh4Node {
    std::array<Box, 4> box;
    std::array<std::uint32_t, 4> child;

    [[nodiscard]] std::uint32_t children() const
    {
        return static_cast<std::uint32_t>(std::ranges::count_if(child, [](auto word) { return word != BVH4_LEAF; }));
    }
};

Bvh4Node read_bvh4_node(const PackedScene& packed, std::uint32_t node)
{
    const auto words = [&](std::size_t quad) {
        const Quad& q = packed.nodes[std::size_t{node} * BVH4_NODE_QUADS + quad];
        return std::array{q.x, q.y, q.z, q.w};
    };
    Bvh4Node read{{}, words(6)};
    for (std::size_t slot = 0; slot < 4; ++slot)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            read.box[slot].low[static_cast<int>(axis)] = std::bit_cast<float>(words(2 * axis)[slot]);
            read.box[slot].high[static_cast<int>(axis)] = std::bit_cast<float>(words(2 * axis + 1)[slot]);
        }
    EXPECT_EQ(words(7), (std::array<std::uint32_t, 4>{}));
    return read;
}

/// Walks the whole tree and checks each box against what it must hold.
class Bvh4Reader {
public:
    Bvh4Reader(const PackedScene& packed, const TriangleMesh& mesh)
        : triangle_boxes(mesh.triangles.size()), packed_(packed), mesh_(mesh)
    {
        read(0, 0);
    }

    std::vector<std::uint32_t> node_order; ///< as met, the largest child first
    std::vector<std::uint32_t> leaf_order; ///< leaf triangles as met
    std::vector<Box> triangle_boxes;       ///< of the leaves of each triangle, merged
    std::uint32_t max_waiting = 0;         ///< children, on the worst ray's stack
    std::size_t children = 0;

private:
    Box read(std::uint32_t index, std::uint32_t waiting)
    {
        node_order.push_back(index);
        const Bvh4Node node = read_bvh4_node(packed_, index);
        const std::uint32_t count = node.children();
        children += count;
        waiting += count - 1;
        max_waiting = std::max(max_waiting, waiting);
        std::vector<std::size_t> order = {0, 1, 2, 3};
        std::ranges::stable_sort(order, std::ranges::greater(),
                                 [&](std::size_t slot) { return slot < count ? half_area(node.box[slot]) : -1.0; });
        Box all;
        for (const std::size_t slot : order) {
            if (slot >= count) {
                EXPECT_EQ(node.child[slot], BVH4_LEAF) << "empty slots are the last";
                EXPECT_EQ(node.box[slot].low, (Float3{BVH4_OUTSIDE, BVH4_OUTSIDE, BVH4_OUTSIDE}));
                EXPECT_EQ(node.box[slot].high, (Float3{-BVH4_OUTSIDE, -BVH4_OUTSIDE, -BVH4_OUTSIDE}));
                continue;
            }
            read_child(node.child[slot], node.box[slot], waiting);
            all = merged(all, node.box[slot]);
        }
        return all;
    }

    void read_child(std::uint32_t child, const Box& box, std::uint32_t waiting)
    {
        if ((child & BVH4_LEAF) == 0) {
            EXPECT_TRUE(contains(box, read(child, waiting))) << "node " << child;
            return;
        }
        const std::uint32_t first = (child & ~BVH4_LEAF) >> 4;
        EXPECT_GE(child & 15, 1u);
        EXPECT_LE(child & 15, four_wide.leaf_triangles);
        for (std::uint32_t i = first; i < first + (child & 15); ++i)
            read_triangle(i, box);
    }

    void read_triangle(std::uint32_t leaf_triangle, const Box& box)
    {
        leaf_order.push_back(leaf_triangle);
        const Quad* quads = &packed_.leaf_triangles[std::size_t{leaf_triangle} * LEAF_TRIANGLE_QUADS];
        const std::uint32_t triangle = quads[0].w;
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(mesh_.vertices[mesh_.triangles[triangle][k]],
                      (Float3{std::bit_cast<float>(quads[k].x), std::bit_cast<float>(quads[k].y),
                              std::bit_cast<float>(quads[k].z)}));
        triangle_boxes[triangle] = merged(triangle_boxes[triangle], box);
    }

    const PackedScene& packed_;
    const TriangleMesh& mesh_;
};

class PackBvh4Of : public testing::TestWithParam<MeshRow> {};

} // namespace

TEST_P(PackBvh4Of, every_triangle_is_reached_within_its_boxes)
{
    const TriangleMesh mesh = GetParam().make();
    const PackedScene packed = make_bvh_scene(mesh, Layout::bvh4);
    EXPECT_EQ(packed.layout, Layout::bvh4);
    EXPECT_EQ(packed.tet_count, 0u);
    EXPECT_EQ(packed.fall_back, "");
    const Bvh4Reader read(packed, mesh);
    EXPECT_EQ(read.node_order, counted_up_to(packed.nodes.size() / BVH4_NODE_QUADS)) << "depth first, largest first";
    EXPECT_EQ(read.leaf_order, counted_up_to(packed.leaf_triangles.size() / LEAF_TRIANGLE_QUADS));
    EXPECT_LE(read.max_waiting, BVH4_STACK);
    EXPECT_EQ(packed.stack_entries, read.max_waiting + 1) << "BVH4_END and those";
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        EXPECT_TRUE(contains(read.triangle_boxes[i], grown(triangle_box(mesh, i), BOX_MARGIN))) << "triangle " << i;
}

INSTANTIATE_TEST_SUITE_P(each, PackBvh4Of, testing::ValuesIn(meshes_to_pack()),
                         [](const auto& tested) { return tested.param.name; });

TEST(PackBvh4, nodes_of_a_surface_are_nearly_full)
{
    const TriangleMesh mesh = make_cubes(10).mesh;
    const Bvh4Reader read(make_bvh_scene(mesh, Layout::bvh4), mesh);
    EXPECT_GT(static_cast<double>(read.children) / static_cast<double>(read.node_order.size()), 3.5);
}

TEST(PackBvh4, one_triangle_is_one_child_of_the_root)
{
    const PackedScene packed = make_bvh_scene(identical_triangles(1), Layout::bvh4);
    EXPECT_EQ(packed.nodes.size(), BVH4_NODE_QUADS);
    EXPECT_EQ(packed.stack_entries, 1u);
    EXPECT_EQ(read_bvh4_node(packed, 0).child, (std::array{BVH4_LEAF | 1u, BVH4_LEAF, BVH4_LEAF, BVH4_LEAF}));
}

// Two parts of a triangle that come into one leaf are one triangle there.
TEST(PackBvh4, a_leaf_has_a_triangle_once)
{
    const TriangleMesh mesh = identical_triangles(1);
    const PackedScene packed = pack_bvh(mesh, chain(40, triangle_box(mesh, 0)), Layout::bvh4);
    const Bvh4Reader read(packed, mesh);
    const std::size_t leaves = read.children - (read.node_order.size() - 1);
    EXPECT_LT(leaves, 41u) << "some were merged";
    EXPECT_EQ(packed.leaf_triangles.size(), leaves * LEAF_TRIANGLE_QUADS);
}

TEST(PackBvh4, trees_that_would_need_a_deeper_stack_are_made_shallow_and_say_so)
{
    const TriangleMesh mesh = nested_in_turn(5, 20, 1000);
    const PackedScene packed = make_bvh_scene(mesh, Layout::bvh4);
    EXPECT_NE(packed.fall_back.find("holds 96"), std::string::npos) << packed.fall_back;
    const Bvh4Reader read(packed, mesh);
    EXPECT_LE(read.max_waiting, BVH4_STACK);
    EXPECT_EQ(packed.stack_entries, read.max_waiting + 1);
}
