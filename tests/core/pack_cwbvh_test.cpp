#include "core/pack/pack_bvh.h"

#include "backends/embree/bvh_builder.h"
#include "core/bvh/bvh.h"
#include "core/bvh/wide_bvh.h"
#include "core/pack/pack_cwbvh.h"
#include "kernels/layouts/layout.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"
#include "tests/support/bvh_scene.h"

#include <gtest/gtest.h>

#include <bit>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// One node's words again.
class CwbvhNode {
public:
    CwbvhNode(const PackedScene& packed, std::uint32_t node)
    {
        for (std::size_t quad = 0; quad < CWBVH_NODE_QUADS; ++quad) {
            const Quad& r = packed.nodes[std::size_t{node} * CWBVH_NODE_QUADS + quad];
            words_.insert(words_.end(), {r.x, r.y, r.z, r.w});
        }
        for (int axis = 0; axis < 3; ++axis) {
            grid_.origin[axis] = std::bit_cast<float>(words_[static_cast<std::size_t>(axis)]);
            grid_.exponent[static_cast<std::size_t>(axis)] = byte(3, static_cast<std::size_t>(axis));
        }
    }

    const BoxGrid& grid() const { return grid_; }
    std::uint32_t inner_bits() const { return words_[3] >> 24; }
    std::uint32_t child_base() const { return words_[4]; }
    std::uint32_t triangle_base() const { return words_[5]; }
    std::uint32_t meta(std::size_t slot) const { return byte(6, slot); }

    /// Rounded outwards to floats: what must be inside is in floats.
    Box box(std::size_t slot) const
    {
        Box box;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t words = 2 * static_cast<std::size_t>(axis);
            box.low[axis] = float_below(line_at(grid_, axis, byte(8 + words, slot)));
            box.high[axis] = float_above(line_at(grid_, axis, byte(14 + words, slot)));
        }
        return box;
    }

private:
    std::uint8_t byte(std::size_t first_word, std::size_t i) const
    {
        return static_cast<std::uint8_t>(words_[first_word + i / 4] >> 8 * (i % 4));
    }
    std::vector<std::uint32_t> words_;
    BoxGrid grid_;
};

bool is_inner(std::uint32_t meta)
{
    return (meta & 31) >= 24;
}

/// Walks the whole tree and checks each box against what it must hold.
class CwbvhReader {
public:
    CwbvhReader(const PackedScene& packed, const TriangleMesh& mesh)
        : triangle_boxes(mesh.triangles.size()), packed_(packed), mesh_(mesh)
    {
        node_seen.resize(packed.nodes.size() / CWBVH_NODE_QUADS);
        read(0, 0);
    }

    std::vector<int> node_seen;
    std::vector<std::uint32_t> leaf_order; ///< leaf triangles as met
    std::vector<Box> triangle_boxes;       ///< of the leaves of each triangle, merged
    std::uint32_t max_waiting = 0;         ///< pairs, on the worst ray's stack: what is left of each node above
    std::size_t children = 0;

private:
    void read(std::uint32_t index, std::uint32_t waiting)
    {
        ++node_seen[index];
        const CwbvhNode node(packed_, index);
        for (std::size_t slot = 0; slot < 8; ++slot) {
            const std::uint32_t meta = node.meta(slot);
            EXPECT_EQ((node.inner_bits() >> slot & 1) != 0, is_inner(meta)) << "node " << index;
            if (meta == 0)
                EXPECT_TRUE(is_empty(node.box(slot))) << "node " << index;
            else
                ++children;
            if (meta != 0 && !is_inner(meta)) read_leaf(node.triangle_base() + (meta & 31), meta >> 5, node.box(slot));
        }
        read_inner(node, waiting + (std::popcount(node.inner_bits()) > 1 ? 1 : 0));
    }

    void read_inner(const CwbvhNode& node, std::uint32_t waiting)
    {
        max_waiting = std::max(max_waiting, waiting);
        std::uint32_t next = node.child_base();
        for (std::size_t slot = 0; slot < 8; ++slot) {
            if (!is_inner(node.meta(slot))) continue;
            EXPECT_EQ(node.meta(slot), 0x20 | (24 + slot));
            expect_round(node, slot, CwbvhNode(packed_, next));
            read(next++, waiting);
        }
    }

    // A child's grid begins at its box's low corner; that box is less than a cell smaller than the parent has it.
    static void expect_round(const CwbvhNode& parent, std::size_t slot, const CwbvhNode& child)
    {
        const Box box = parent.box(slot);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(box.low[axis], child.grid().origin[axis]);
            EXPECT_GT(box.low[axis] + parent.grid().width(axis), child.grid().origin[axis]);
            EXPECT_LT(box.high[axis] - parent.grid().width(axis), line_at(child.grid(), axis, 255));
        }
    }

    void read_leaf(std::uint32_t first, std::uint32_t unary, const Box& box)
    {
        EXPECT_TRUE(unary == 1 || unary == 3 || unary == 7);
        for (std::uint32_t i = first; i < first + static_cast<std::uint32_t>(std::popcount(unary)); ++i) {
            leaf_order.push_back(i);
            const Quad* quads = &packed_.leaf_triangles[std::size_t{i} * LEAF_TRIANGLE_QUADS];
            const std::uint32_t triangle = quads[0].w;
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_EQ(mesh_.vertices[mesh_.triangles[triangle][k]],
                          (Float3{std::bit_cast<float>(quads[k].x), std::bit_cast<float>(quads[k].y),
                                  std::bit_cast<float>(quads[k].z)}));
            triangle_boxes[triangle] = merged(triangle_boxes[triangle], box);
        }
    }

    const PackedScene& packed_;
    const TriangleMesh& mesh_;
};

class PackCwbvhOf : public testing::TestWithParam<MeshRow> {};

} // namespace

TEST_P(PackCwbvhOf, every_triangle_is_reached_within_its_boxes)
{
    const TriangleMesh mesh = GetParam().make();
    const PackedScene packed = make_bvh_scene(mesh, Layout::cwbvh);
    EXPECT_EQ(packed.layout, Layout::cwbvh);
    EXPECT_EQ(packed.tet_count, 0u);
    const CwbvhReader read(packed, mesh);
    EXPECT_EQ(read.node_seen, std::vector<int>(read.node_seen.size(), 1));
    EXPECT_EQ(read.leaf_order, counted_up_to(packed.leaf_triangles.size() / LEAF_TRIANGLE_QUADS))
        << "in the order of their leaves";
    EXPECT_LE(read.max_waiting, CWBVH_STACK);
    EXPECT_EQ(packed.stack_entries, std::max(read.max_waiting, 1u));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        EXPECT_TRUE(contains(read.triangle_boxes[i], grown(triangle_box(mesh, i), BOX_MARGIN))) << "triangle " << i;
}

INSTANTIATE_TEST_SUITE_P(each, PackCwbvhOf, testing::ValuesIn(meshes_to_pack()),
                         [](const auto& tested) { return tested.param.name; });

TEST(PackCwbvh, trees_that_would_be_too_deep_are_made_shallow_and_say_so)
{
    const TriangleMesh mesh = nested_in_turn(5, 20, 1000);
    const Bvh bvh = build_bvh(mesh).bvh;
    ASSERT_GT(levels_of(make_wide(with_single_leaves(mesh, bvh), eight_wide, Collapse::cheapest)), CWBVH_STACK);
    const PackedScene packed = pack_bvh(mesh, bvh, Layout::cwbvh);
    EXPECT_NE(packed.fall_back.find("holds 40"), std::string::npos) << packed.fall_back;
    const CwbvhReader read(packed, mesh);
    EXPECT_LE(read.max_waiting, CWBVH_STACK);
    EXPECT_EQ(packed.stack_entries, read.max_waiting);
    EXPECT_EQ(make_bvh_scene(nested_groups(2, 40, 20), Layout::cwbvh).fall_back, "");
}

TEST(PackCwbvh, nodes_of_a_surface_are_nearly_full)
{
    const TriangleMesh mesh = make_cubes(10).mesh;
    const PackedScene packed = make_bvh_scene(mesh, Layout::cwbvh);
    const CwbvhReader read(packed, mesh);
    EXPECT_GT(static_cast<double>(read.children) / static_cast<double>(read.node_seen.size()), 7.0);
}

TEST(PackCwbvh, one_triangle_is_one_child_of_the_root)
{
    const PackedScene packed = make_bvh_scene(identical_triangles(1), Layout::cwbvh);
    const CwbvhNode root(packed, 0);
    EXPECT_EQ(packed.nodes.size(), CWBVH_NODE_QUADS);
    int leaves = 0;
    for (std::size_t slot = 0; slot < 8; ++slot)
        leaves += root.meta(slot) == 0x20 ? 1 : 0;
    EXPECT_EQ(leaves, 1);
    EXPECT_EQ(root.inner_bits(), 0u);
}

// Bit 2 of a slot: the child is high in x, which rays towards low x meet first; bit 1 y, bit 0 z.
TEST(PackCwbvh, children_stand_in_the_slots_of_their_octants)
{
    const PackedScene packed = make_bvh_scene(cube_corners(), Layout::cwbvh);
    const CwbvhNode root(packed, 0);
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
        ASSERT_NE(root.meta(slot), 0u);
        const std::uint32_t first = root.triangle_base() + (root.meta(slot) & 31);
        EXPECT_EQ(packed.leaf_triangles[std::size_t{first} * LEAF_TRIANGLE_QUADS].w, slot);
    }
}

// Two parts of a triangle that come into one leaf are one triangle there.
TEST(PackCwbvh, a_leaf_has_a_triangle_once)
{
    const TriangleMesh mesh = identical_triangles(1);
    const PackedScene packed = pack_bvh(mesh, chain(40, triangle_box(mesh, 0)), Layout::cwbvh);
    const CwbvhReader read(packed, mesh);
    const std::size_t leaves = read.children - (read.node_seen.size() - 1);
    EXPECT_LT(leaves, 41u) << "some were merged";
    EXPECT_EQ(packed.leaf_triangles.size(), leaves * LEAF_TRIANGLE_QUADS);
}
