#include "core/pack_bvh.h"

#include "kernels/layout.h"
#include "scenes/bvh_scene.h"
#include "scenes/procedural.h"

#include <gtest/gtest.h>

#include <bit>

namespace tetrace {
namespace {

/// A BVH's packed words again, each box with what it must hold.
class Bvh2Reader {
public:
    Bvh2Reader(const PackedScene& packed, const TriangleMesh& mesh) : packed_(packed), mesh_(mesh)
    {
        triangle_boxes_.resize(mesh.triangles.size());
        read_node(0, 0);
    }

    std::size_t nodes = 0;
    std::uint32_t depth = 0;
    std::vector<std::uint32_t> leaf_order; ///< leaf triangles as the leaves are met
    std::vector<Box> triangle_boxes_;      ///< of the leaves of each triangle, merged

private:
    static float number(std::uint32_t bits) { return std::bit_cast<float>(bits); }

    Box read_node(std::uint32_t node, std::uint32_t waiting)
    {
        nodes++;
        depth = std::max(depth, waiting + 1);
        const Row* rows = &packed_.nodes[std::size_t{node} * BVH2_NODE_ROWS];
        Box both;
        for (const int side : {0, 1}) {
            const Row& xy = rows[side];
            const Row& z = rows[2];
            const Box box = {{number(xy.x), number(xy.z), number(side == 0 ? z.x : z.z)},
                             {number(xy.y), number(xy.w), number(side == 0 ? z.y : z.w)}};
            read_child(side == 0 ? rows[3].x : rows[3].y, box, waiting + 1);
            both = merged(both, box);
        }
        return both;
    }

    void read_child(std::uint32_t child, const Box& box, std::uint32_t waiting)
    {
        if ((child & BVH2_LEAF) == 0) {
            EXPECT_TRUE(contains(box, read_node(child, waiting)));
            return;
        }
        const std::uint32_t first = (child & ~BVH2_LEAF) >> 4;
        for (std::uint32_t i = first; i < first + (child & 15); i++) {
            const Row* rows = &packed_.leaf_triangles[std::size_t{i} * LEAF_TRIANGLE_ROWS];
            const std::uint32_t triangle = rows[0].w;
            for (std::size_t k = 0; k < 3; k++)
                EXPECT_EQ(mesh_.vertices[mesh_.triangles[triangle][k]],
                          (Float3{number(rows[k].x), number(rows[k].y), number(rows[k].z)}));
            triangle_boxes_[triangle] = merged(triangle_boxes_[triangle], box);
            leaf_order.push_back(i);
        }
    }

    const PackedScene& packed_;
    const TriangleMesh& mesh_;
};

TEST(PackBvh2, every_triangle_is_reached_within_its_boxes)
{
    const TriangleMesh mesh = make_cubes(6).mesh;
    const PackedScene packed = make_bvh_scene(mesh, Layout::bvh2);
    const Bvh2Reader read(packed, mesh);
    EXPECT_EQ(read.nodes * BVH2_NODE_ROWS, packed.nodes.size());
    EXPECT_EQ(read.leaf_order.size() * LEAF_TRIANGLE_ROWS, packed.leaf_triangles.size());
    EXPECT_LE(read.depth, BVH2_STACK);
    for (std::size_t i = 0; i < mesh.triangles.size(); i++)
        EXPECT_TRUE(contains(read.triangle_boxes_[i], grown(triangle_box(mesh, i), BOX_MARGIN))) << "triangle " << i;
}

} // namespace
} // namespace tetrace
