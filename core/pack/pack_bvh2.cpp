#include "core/pack/pack_bvh.h"

#include "kernels/layouts/layout.h"

#include <algorithm>
#include <bit>

namespace tetrace {
namespace {

std::uint32_t float_bits(float x)
{
    return std::bit_cast<std::uint32_t>(x);
}

class Bvh2Packer {
public:
    Bvh2Packer(const TriangleMesh& mesh, const Bvh& bvh) : mesh_(mesh), bvh_(bvh) {}

    PackedScene pack()
    {
        if (bvh_.nodes.front().count > 0)
            add_only_leaf();
        else
            add_node(0);
        return std::move(packed_);
    }

private:
    /// The child that more rays meet comes next in memory.
    std::uint32_t add_node(std::uint32_t index)
    {
        const auto& child = bvh_.nodes[index].child;
        const auto node = add_quads(box(child[0]), box(child[1]));
        std::uint32_t packed_child[2] = {};
        const std::size_t larger = half_area(box(child[1])) > half_area(box(child[0])) ? 1 : 0;
        for (const std::size_t i : {larger, 1 - larger})
            packed_child[i] = add_child(child[i]);
        set_children(node, packed_child[0], packed_child[1]);
        return node;
    }

    std::uint32_t add_child(std::uint32_t index)
    {
        return bvh_.nodes[index].count > 0 ? add_leaf(bvh_.nodes[index]) : add_node(index);
    }

    std::uint32_t add_leaf(const BvhNode& leaf)
    {
        const auto triangles = std::span(bvh_.references).subspan(leaf.first, leaf.count);
        return BVH2_LEAF | add_leaf_triangles(packed_, mesh_, triangles) << 4 | leaf.count;
    }

    // A root has two children: the second is empty.
    void add_only_leaf()
    {
        const auto node = add_quads(box(0), box(0));
        set_children(node, add_leaf(bvh_.nodes.front()), BVH2_LEAF);
    }

    [[nodiscard]] Box box(std::uint32_t node) const { return grown(bvh_.nodes[node].box, BOX_MARGIN); }

    std::uint32_t add_quads(const Box& a, const Box& b)
    {
        const auto node = static_cast<std::uint32_t>(packed_.nodes.size() / BVH2_NODE_QUADS);
        packed_.nodes.push_back({float_bits(a.low.x), float_bits(a.high.x), float_bits(a.low.y), float_bits(a.high.y)});
        packed_.nodes.push_back({float_bits(b.low.x), float_bits(b.high.x), float_bits(b.low.y), float_bits(b.high.y)});
        packed_.nodes.push_back({float_bits(a.low.z), float_bits(a.high.z), float_bits(b.low.z), float_bits(b.high.z)});
        packed_.nodes.emplace_back();
        return node;
    }

    void set_children(std::uint32_t node, std::uint32_t a, std::uint32_t b)
    {
        packed_.nodes[std::size_t{node} * BVH2_NODE_QUADS + 3] = {a, b, 0, 0};
    }

    const TriangleMesh& mesh_;
    const Bvh& bvh_;
    PackedScene packed_;
};

} // namespace

PackedScene pack_bvh2(const TriangleMesh& mesh, const Bvh& bvh)
{
    const auto depth = depth_of(bvh);
    if (depth > BVH2_STACK) refuse_to_pack(Layout::bvh2, depth, "children would wait on a ray's stack", BVH2_STACK);
    PackedScene packed = Bvh2Packer(mesh, bvh).pack();
    packed.stack_entries = 1 + std::max(depth, 1u); // BVH2_END; a packed root has two children even if it was a leaf
    return packed;
}

} // namespace tetrace
