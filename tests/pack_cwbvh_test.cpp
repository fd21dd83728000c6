#include "core/pack_bvh.h"

#include "core/box_grid.h"
#include "kernels/layout.h"
#include "scenes/bvh_scene.h"
#include "scenes/procedural.h"

#include <gtest/gtest.h>

#include <bit>

namespace tetrace {
namespace {

/// A BVH's packed words again, each box with what it must hold.
class CwbvhReader {
public:
    CwbvhReader(const PackedScene& packed, const TriangleMesh& mesh)
        : triangle_boxes(mesh.triangles.size()), packed_(packed), mesh_(mesh)
    {
        read_node(0, 1);
    }

    std::size_t nodes = 0, children = 0;
    std::uint32_t levels = 0;
    std::vector<std::uint32_t> leaf_order; ///< leaf triangles as the leaves are met
    std::vector<Box> triangle_boxes;       ///< of the leaves of each triangle, merged

private:
    std::uint32_t word(std::uint32_t node, std::size_t i) const
    {
        const Row& row = packed_.nodes[std::size_t{node} * CWBVH_NODE_ROWS + i / 4];
        return i % 4 == 0 ? row.x : i % 4 == 1 ? row.y : i % 4 == 2 ? row.z : row.w;
    }
    std::uint8_t byte(std::uint32_t node, std::size_t first_word, std::size_t i) const
    {
        return static_cast<std::uint8_t>(word(node, first_word + i / 4) >> 8 * (i % 4));
    }

    // Outwards to floats: what must be inside is in floats.
    Box child_box(std::uint32_t node, std::size_t slot) const
    {
        BoxGrid grid;
        Box box;
        for (int axis = 0; axis < 3; axis++) {
            const auto i = static_cast<std::size_t>(axis);
            grid.origin[axis] = std::bit_cast<float>(word(node, i));
            grid.exponent[i] = byte(node, 3, i);
            box.low[axis] = float_below(line_at(grid, axis, byte(node, 8 + 2 * i, slot)));
            box.high[axis] = float_above(line_at(grid, axis, byte(node, 14 + 2 * i, slot)));
        }
        return box;
    }

    void read_node(std::uint32_t node, std::uint32_t level)
    {
        nodes++;
        levels = std::max(levels, level);
        std::uint32_t inner = 0;
        for (std::size_t slot = 0; slot < 8; slot++) {
            const std::uint32_t meta = byte(node, 6, slot);
            EXPECT_EQ((word(node, 3) >> (24 + slot) & 1) != 0, (meta & 31) >= 24) << "node " << node;
            if (meta == 0) continue;
            children++;
            const Box box = child_box(node, slot);
            if ((meta & 31) >= 24) {
                EXPECT_EQ(meta, 0x20 | (24 + slot));
                read_node(word(node, 4) + inner++, level + 1);
            } else {
                read_leaf(word(node, 5) + (meta & 31), meta >> 5, box);
            }
        }
    }

    void read_leaf(std::uint32_t first, std::uint32_t unary, const Box& box)
    {
        EXPECT_TRUE(unary == 1 || unary == 3 || unary == 7);
        for (std::uint32_t i = first; i < first + static_cast<std::uint32_t>(std::popcount(unary)); i++) {
            const Row* rows = &packed_.leaf_triangles[std::size_t{i} * LEAF_TRIANGLE_ROWS];
            const std::uint32_t triangle = rows[0].w;
            for (std::size_t k = 0; k < 3; k++)
                EXPECT_EQ(mesh_.vertices[mesh_.triangles[triangle][k]],
                          (Float3{std::bit_cast<float>(rows[k].x), std::bit_cast<float>(rows[k].y),
                                  std::bit_cast<float>(rows[k].z)}));
            triangle_boxes[triangle] = merged(triangle_boxes[triangle], box);
            leaf_order.push_back(i);
        }
    }

    const PackedScene& packed_;
    const TriangleMesh& mesh_;
};

TEST(PackCwbvh, every_triangle_is_reached_within_its_boxes)
{
    const TriangleMesh mesh = make_cubes(6).mesh;
    const PackedScene packed = make_bvh_scene(mesh, Layout::cwbvh);
    const CwbvhReader read(packed, mesh);
    EXPECT_EQ(read.nodes * CWBVH_NODE_ROWS, packed.nodes.size());
    EXPECT_EQ(read.leaf_order.size() * LEAF_TRIANGLE_ROWS, packed.leaf_triangles.size());
    EXPECT_LE(read.levels, CWBVH_STACK);
    for (std::size_t i = 0; i < mesh.triangles.size(); i++)
        EXPECT_TRUE(contains(read.triangle_boxes[i], grown(triangle_box(mesh, i), BOX_MARGIN))) << "triangle " << i;
}

} // namespace
} // namespace tetrace
