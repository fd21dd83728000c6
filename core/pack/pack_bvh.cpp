#include "core/pack/pack_bvh.h"

#include "core/base/error.h"
#include "core/bvh/bvh.h"
#include "core/bvh/wide_bvh.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace tetrace {

std::uint32_t add_leaf_triangles(PackedScene& packed, const TriangleMesh& mesh,
                                 std::span<const std::uint32_t> triangles)
{
    const auto first = static_cast<std::uint32_t>(packed.leaf_triangles.size() / LEAF_TRIANGLE_QUADS);
    for (const auto triangle : triangles) {
        std::uint32_t last_word = triangle;
        for (const auto v : mesh.triangles[triangle]) {
            const Float3 a = mesh.vertices[v];
            packed.leaf_triangles.push_back({std::bit_cast<std::uint32_t>(a.x), std::bit_cast<std::uint32_t>(a.y),
                                             std::bit_cast<std::uint32_t>(a.z), last_word});
            last_word = 0;
        }
    }
    return first;
}

std::vector<std::uint32_t> triangles_of_leaf(const WideBvh& wide, const WideChild& leaf)
{
    const auto references = std::span(wide.references).subspan(leaf.first, leaf.count);
    std::vector<std::uint32_t> triangles(references.begin(), references.end());
    std::ranges::sort(triangles);
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return triangles;
}

Box grown_box(const WideChild& child)
{
    return grown(child.box, BOX_MARGIN);
}

void refuse_to_pack(Layout layout, std::uint64_t found, const char* what, std::uint64_t most)
{
    throw Error(ErrorKind::unsupported, "packing a BVH as " + std::string(name_of(layout)) + ": " +
                                            std::to_string(found) + ' ' + what + ", but its kernels support at most " +
                                            std::to_string(most) + "; use a smaller mesh");
}

PackedScene pack_bvh(const TriangleMesh& mesh, const Bvh& bvh, Layout layout)
{
    const LayoutTraits& traits = traits_of(layout);
    const auto* const pack_nodes = std::get_if<PackBvh*>(&traits.pack);
    if (pack_nodes == nullptr)
        throw Error(ErrorKind::internal, "packing a BVH as " + std::string(traits.name) + ": no layout of BVHs");
    if (bvh.references.size() > traits.most)
        refuse_to_pack(layout, bvh.references.size(), "references of leaves to triangles", traits.most);
    for (const auto& node : bvh.nodes)
        if (node.count > max_leaf_references)
            refuse_to_pack(layout, node.count, "triangles in a leaf", max_leaf_references);
    PackedScene packed = (*pack_nodes)(mesh, bvh);
    packed.layout = layout;
    return packed;
}

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
