#include "core/pack/pack_bvh.h"

#include "backends/embree/bvh_builder.h"
#include "core/base/error.h"
#include "kernels/layouts/layout.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"
#include "tests/support/bvh_scene.h"

#include <gtest/gtest.h>

#include <bit>

using namespace tetrace;
using namespace tetrace::test;

namespace {

float number(std::uint32_t bits)
{
    return std::bit_cast<float>(bits);
}

/// A node's words again.
struct Bvh2Node {
    Box box[2];
    std::uint32_t child[2];
};
Bvh2Node read_bvh2_node(const PackedScene& packed, std::uint32_t node)
{
    const Quad* quads = &packed.nodes[std::size_t{node} * BVH2_NODE_QUADS];
    const auto& [a, b, z, child] = std::array{quads[0], quads[1], quads[2], quads[3]};
    return {{{{number(a.x), number(a.z), number(z.x)}, {number(a.y), number(a.w), number(z.y)}},
             {{number(b.x), number(b.z), number(z.z)}, {number(b.y), number(b.w), number(z.w)}}},
            {child.x, child.y}};
}

/// Walks the whole tree and checks each box against what it must hold.
class Bvh2Reader {
public:
    Bvh2Reader(const PackedScene& packed, const TriangleMesh& mesh)
        : triangle_boxes(mesh.triangles.size()), packed_(packed), mesh_(mesh)
    {
        read(0, 0);
    }

    std::vector<std::uint32_t> node_order; ///< as met, larger child first
    std::vector<std::uint32_t> leaf_order; ///< leaf triangles as met
    std::vector<Box> triangle_boxes;       ///< of the leaves of each triangle, merged
    std::uint32_t max_waiting = 0;         ///< far children, on the worst ray's stack

private:
    Box read(std::uint32_t index, std::uint32_t waiting)
    {
        node_order.push_back(index);
        const Bvh2Node node = read_bvh2_node(packed_, index);
        max_waiting = std::max(max_waiting, waiting + 1);
        const int larger = half_area(node.box[1]) > half_area(node.box[0]) ? 1 : 0;
        for (const int side : {larger, 1 - larger})
            read_child(node.child[side], node.box[side], waiting + 1);
        return merged(node.box[0], node.box[1]);
    }

    void read_child(std::uint32_t child, const Box& box, std::uint32_t waiting)
    {
        if ((child & BVH2_LEAF) == 0) {
            EXPECT_TRUE(contains(box, read(child, waiting))) << "node " << child;
            return;
        }
        const std::uint32_t first = (child & ~BVH2_LEAF) >> 4;
        for (std::uint32_t i = first; i < first + (child & 15); ++i)
            read_triangle(i, box);
    }

    void read_triangle(std::uint32_t leaf_triangle, const Box& box)
    {
        leaf_order.push_back(leaf_triangle);
        const Quad* quads = &packed_.leaf_triangles[std::size_t{leaf_triangle} * LEAF_TRIANGLE_QUADS];
        const std::uint32_t triangle = quads[0].w;
        EXPECT_EQ(quads[1].w, 0u);
        EXPECT_EQ(quads[2].w, 0u);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(mesh_.vertices[mesh_.triangles[triangle][k]],
                      (Float3{number(quads[k].x), number(quads[k].y), number(quads[k].z)}));
        triangle_boxes[triangle] = merged(triangle_boxes[triangle], box);
    }

    const PackedScene& packed_;
    const TriangleMesh& mesh_;
};

class PackBvh2Of : public testing::TestWithParam<MeshRow> {};

} // namespace

TEST_P(PackBvh2Of, every_triangle_is_reached_within_its_boxes)
{
    const TriangleMesh mesh = GetParam().make();
    const PackedScene packed = make_bvh_scene(mesh, Layout::bvh2);
    EXPECT_EQ(packed.layout, Layout::bvh2);
    EXPECT_EQ(packed.tet_count, 0u);
    const Bvh2Reader read(packed, mesh);
    EXPECT_EQ(read.node_order, counted_up_to(packed.nodes.size() / BVH2_NODE_QUADS)) << "depth first, larger first";
    EXPECT_EQ(read.leaf_order, counted_up_to(packed.leaf_triangles.size() / LEAF_TRIANGLE_QUADS));
    EXPECT_LE(read.max_waiting, BVH2_STACK);
    EXPECT_EQ(packed.stack_entries, read.max_waiting + 1) << "BVH2_END and those";
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        EXPECT_TRUE(contains(read.triangle_boxes[i], grown(triangle_box(mesh, i), BOX_MARGIN))) << "triangle " << i;
}

INSTANTIATE_TEST_SUITE_P(each, PackBvh2Of, testing::ValuesIn(meshes_to_pack()),
                         [](const auto& tested) { return tested.param.name; });

TEST(PackBvh2, boxes_are_the_trees_and_the_margin)
{
    const TriangleMesh mesh = needles(50);
    const Bvh bvh = build_bvh(mesh).bvh;
    const Bvh2Node root = read_bvh2_node(pack_bvh(mesh, bvh, Layout::bvh2), 0);
    for (const std::size_t i : {0u, 1u})
        EXPECT_EQ(root.box[i], grown(bvh.nodes[bvh.nodes[0].child[i]].box, BOX_MARGIN));
}

TEST(PackBvh2, one_leaf_has_an_empty_sibling_of_the_same_box)
{
    const TriangleMesh mesh = identical_triangles(3);
    const PackedScene packed = pack_bvh(mesh, {{{triangle_box(mesh, 0), {}, 0, 3}}, {2, 0, 1}}, Layout::bvh2);
    const Bvh2Node root = read_bvh2_node(packed, 0);
    EXPECT_EQ(packed.nodes.size(), BVH2_NODE_QUADS);
    EXPECT_EQ(root.child[0], BVH2_LEAF | 3u);
    EXPECT_EQ(root.child[1], BVH2_LEAF);
    EXPECT_EQ(root.box[0], root.box[1]);
    EXPECT_EQ(packed.leaf_triangles[0].w, 2u);
}

namespace {

std::string refusal(const TriangleMesh& mesh, const Bvh& bvh, Layout layout)
{
    try {
        (void)pack_bvh(mesh, bvh, layout);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::unsupported);
        return error.what();
    }
    return "";
}

} // namespace

TEST(PackBvh, trees_deeper_than_the_stack_are_refused_with_both_numbers)
{
    const TriangleMesh mesh = identical_triangles(1);
    const Box box = triangle_box(mesh, 0);
    EXPECT_EQ(refusal(mesh, chain(BVH2_STACK, box), Layout::bvh2), "");
    const std::string text = refusal(mesh, chain(BVH2_STACK + 1, box), Layout::bvh2);
    EXPECT_NE(text.find("65 "), std::string::npos) << text;
    EXPECT_NE(text.find("at most 64"), std::string::npos) << text;
    EXPECT_EQ(refusal(mesh, chain(BVH4_STACK / 3 * 2, box), Layout::bvh4), "");
    EXPECT_NE(refusal(mesh, chain(65, box), Layout::bvh4).find("65 "), std::string::npos);
    EXPECT_EQ(refusal(mesh, chain(3 * CWBVH_STACK, box), Layout::cwbvh), "");
    EXPECT_NE(refusal(mesh, chain(100'000, box), Layout::cwbvh).find("100000 "), std::string::npos);
}

TEST(PackBvh, leaves_of_more_than_15_triangles_are_refused)
{
    const TriangleMesh mesh = identical_triangles(16);
    for (const auto layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        Bvh bvh = {{{triangle_box(mesh, 0), {}, 0, 16}}, counted_up_to(16)};
        EXPECT_NE(refusal(mesh, bvh, layout).find("16 triangles in a leaf"), std::string::npos);
        bvh.nodes[0].count = 15;
        EXPECT_EQ(refusal(mesh, bvh, layout), "");
    }
}

TEST(PackBvh, a_layout_numbers_no_more_references_than_its_words_hold)
{
    EXPECT_EQ(traits_of(Layout::bvh2).most, 1u << 27) << "31 bits, four of them for the count";
    EXPECT_EQ(traits_of(Layout::bvh4).most, 1u << 27) << "as those of bvh2";
    EXPECT_EQ(traits_of(Layout::cwbvh).most, 1'431'655'765u) << "three quads each, quads numbered with 32 bits";
}

TEST(PackBvh, layouts_of_tets_are_refused)
{
    const TriangleMesh mesh = identical_triangles(1);
    EXPECT_THROW((void)make_bvh_scene(mesh, Layout::tet80), Error);
    EXPECT_THROW((void)make_bvh_scene(mesh, Layout::embree), Error);
}
