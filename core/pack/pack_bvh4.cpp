#include "core/pack/pack_bvh.h"

#include "core/bvh/single_leaves.h"
#include "core/bvh/wide_bvh.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace tetrace {
namespace {

static_assert(four_wide.leaf_triangles <= max_leaf_references);

/// The words of a node as a device reads them.
using Bvh4Node = std::array<std::uint32_t, 4 * std::size_t{BVH4_NODE_QUADS}>;

/// Appends a BVH's nodes, each followed by the subtrees of its children, the largest box first: more rays meet it.
class Bvh4Packer {
public:
    Bvh4Packer(const TriangleMesh& mesh, const WideBvh& wide) : mesh_(mesh), wide_(wide) {}

    PackedScene pack()
    {
        add_node(0, 0);
        return std::move(packed_);
    }

private:
    /// waiting: children of nodes above this one that may wait on a ray's stack. Returns the node's number.
    std::uint32_t add_node(std::uint32_t index, std::uint32_t waiting)
    {
        const WideNode& children = wide_.nodes[index];
        const auto node = static_cast<std::uint32_t>(packed_.nodes.size() / BVH4_NODE_QUADS);
        packed_.nodes.resize(packed_.nodes.size() + BVH4_NODE_QUADS);
        waiting += static_cast<std::uint32_t>(children.size()) - 1;
        packed_.stack_entries = std::max(packed_.stack_entries, 1 + waiting); // below them is BVH4_END

        std::vector<std::size_t> order(children.size());
        for (std::size_t slot = 0; slot < order.size(); ++slot)
            order[slot] = slot;
        std::ranges::stable_sort(order, std::ranges::greater(),
                                 [&](std::size_t slot) { return half_area(grown_box(children[slot])); });
        std::array<std::uint32_t, 4> packed_child = {};
        packed_child.fill(BVH4_LEAF);
        for (const std::size_t slot : order)
            packed_child[slot] = add_child(children[slot], waiting);
        set_node(node, children, packed_child);
        return node;
    }

    std::uint32_t add_child(const WideChild& child, std::uint32_t waiting)
    {
        if (child.count == 0) return add_node(child.node, waiting);
        const auto triangles = triangles_of_leaf(wide_, child);
        return BVH4_LEAF | add_leaf_triangles(packed_, mesh_, triangles) << 4 |
               static_cast<std::uint32_t>(triangles.size());
    }

    void set_node(std::uint32_t node, const WideNode& children, const std::array<std::uint32_t, 4>& packed_child)
    {
        Bvh4Node words = {};
        for (std::size_t slot = 0; slot < four_wide.children; ++slot) {
            const bool empty = slot >= children.size();
            const Box box = empty ? Box{} : grown_box(children[slot]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float low = empty ? BVH4_OUTSIDE : box.low[static_cast<int>(axis)];
                const float high = empty ? -BVH4_OUTSIDE : box.high[static_cast<int>(axis)];
                words[8 * axis + slot] = std::bit_cast<std::uint32_t>(low);
                words[8 * axis + 4 + slot] = std::bit_cast<std::uint32_t>(high);
            }
            words[24 + slot] = packed_child[slot];
        }
        for (std::size_t quad = 0; quad < BVH4_NODE_QUADS; ++quad)
            packed_.nodes[std::size_t{node} * BVH4_NODE_QUADS + quad] = {words[4 * quad], words[4 * quad + 1],
                                                                         words[4 * quad + 2], words[4 * quad + 3]};
    }

    const TriangleMesh& mesh_;
    const WideBvh& wide_;
    PackedScene packed_;
};

} // namespace

PackedScene pack_bvh4(const TriangleMesh& mesh, const Bvh& bvh)
{
    constexpr std::uint32_t max_depth = BVH4_STACK / 3 * 2; // of two binary levels, three children wait
    if (const auto depth = depth_of(bvh); depth > max_depth)
        refuse_to_pack(Layout::bvh4, depth, "inner nodes above a leaf", max_depth);
    const Bvh binary = with_single_leaves(mesh, bvh);
    const auto packed_as = [&](Collapse collapse) {
        return Bvh4Packer(mesh, make_wide(binary, four_wide, collapse)).pack();
    };
    PackedScene packed = packed_as(Collapse::cheapest);
    if (packed.stack_entries <= BVH4_STACK + 1) return packed;
    const std::string fall_back = "two binary levels are one of four children: of the cheapest nodes, " +
                                  std::to_string(packed.stack_entries - 1) + " children would wait on a ray's stack, " +
                                  "which holds " + std::to_string(BVH4_STACK);
    packed = packed_as(Collapse::shallow);
    if (packed.stack_entries > BVH4_STACK + 1)
        refuse_to_pack(Layout::bvh4, packed.stack_entries - 1, "children would wait on a ray's stack", BVH4_STACK);
    packed.fall_back = fall_back;
    return packed;
}

} // namespace tetrace
