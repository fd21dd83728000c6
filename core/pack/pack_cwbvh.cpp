#include "core/pack/pack_cwbvh.h"

#include "core/bvh/bvh.h"
#include "core/bvh/wide_bvh.h"
#include "core/pack/pack_bvh.h"
#include "kernels/layouts/layout.h"

#include <array>
#include <bit>
#include <limits>
#include <string>

namespace tetrace {

namespace {

constexpr int last_line = 255;

// Rounding in the division and in line_at() must not move a line into the box.
int line_below(const BoxGrid& grid, int axis, float x)
{
    int line = static_cast<int>(std::floor((double{x} - grid.origin[axis]) / grid.width(axis)));
    line = std::clamp(line, 0, last_line);
    while (line > 0 && line_at(grid, axis, static_cast<std::uint8_t>(line)) > x)
        --line;
    return line;
}

/// last_line + 1 where the grid ends before x.
int line_above(const BoxGrid& grid, int axis, float x)
{
    const double line = std::ceil((double{x} - grid.origin[axis]) / grid.width(axis));
    if (line > last_line) return last_line + 1;
    int above = std::max(0, static_cast<int>(line));
    while (above <= last_line && line_at(grid, axis, static_cast<std::uint8_t>(above)) < x)
        ++above;
    return above;
}

} // namespace

double line_at(const BoxGrid& grid, int axis, std::uint8_t line)
{
    return double{grid.origin[axis]} + line * grid.width(axis);
}

BoxGrid make_box_grid(const Box& box)
{
    BoxGrid grid{box.low, {}};
    for (int axis = 0; axis < 3; ++axis) {
        auto& exponent = grid.exponent[static_cast<std::size_t>(axis)];
        const double width = (double{box.high[axis]} - box.low[axis]) / last_line;
        exponent = static_cast<std::uint8_t>(std::clamp(width > 0 ? std::ilogb(width) + 127 : 1, 1, 254));
        while (exponent < 254 && line_above(grid, axis, box.high[axis]) > last_line)
            ++exponent;
    }
    return grid;
}

GridBox to_grid(const BoxGrid& grid, const Box& box)
{
    GridBox lines;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        lines.low[i] = static_cast<std::uint8_t>(line_below(grid, axis, box.low[axis]));
        lines.high[i] = static_cast<std::uint8_t>(std::min(last_line, line_above(grid, axis, box.high[axis])));
    }
    return lines;
}

double slot_cost(Double3 offset, std::uint32_t slot)
{
    return ((slot & 4) != 0 ? -offset.x : offset.x) + ((slot & 2) != 0 ? -offset.y : offset.y) +
           ((slot & 1) != 0 ? -offset.z : offset.z);
}

// The first n children occupy a set of n slots. The best assignment to that set extends the best assignment to a subset
// of n - 1 slots.
std::vector<std::uint8_t> octant_slots(std::span<const Double3> offsets)
{
    constexpr std::uint32_t sets = 256;
    std::array<double, sets> least = {};
    std::array<std::uint8_t, sets> last_slot = {};
    for (std::uint32_t taken = 1; taken < sets; ++taken) {
        const auto child = static_cast<std::size_t>(std::popcount(taken)) - 1;
        if (child >= offsets.size()) continue;
        least[taken] = std::numeric_limits<double>::infinity();
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            if ((taken >> slot & 1) == 0) continue;
            const double cost = least[taken & ~(1u << slot)] + slot_cost(offsets[child], slot);
            if (cost < least[taken]) {
                least[taken] = cost;
                last_slot[taken] = static_cast<std::uint8_t>(slot);
            }
        }
    }

    std::uint32_t best = sets;
    for (std::uint32_t taken = 0; taken < sets; ++taken)
        if (static_cast<std::size_t>(std::popcount(taken)) == offsets.size() &&
            (best == sets || least[taken] < least[best]))
            best = taken;
    std::vector<std::uint8_t> slots(offsets.size());
    for (std::size_t child = offsets.size(); child-- > 0;) {
        slots[child] = last_slot[best];
        best &= ~(1u << slots[child]);
    }
    return slots;
}

namespace {

static_assert(eight_wide.leaf_triangles == CWBVH_LEAF_TRIANGLES);

/// The words of a node as a device reads them.
struct CwbvhNode {
    std::array<std::uint32_t, 4 * std::size_t{CWBVH_NODE_QUADS}> words = {};

    static constexpr std::size_t grid_word = 3, child_base = 4, triangle_base = 5, meta = 6, low = 8, high = 14;

    /// Byte `slot` of the eight bytes that begin at a word.
    void set_byte(std::size_t word, std::size_t slot, std::uint32_t value)
    {
        words[word + slot / 4] |= value << 8 * (slot % 4);
    }
    void append_to(std::vector<Quad>& quads, std::size_t at) const
    {
        for (std::size_t i = 0; i < words.size(); i += 4)
            quads[at + i / 4] = {words[i], words[i + 1], words[i + 2], words[i + 3]};
    }
};

/// A node's children by slot; null in an empty slot.
using SlottedChildren = std::array<const WideChild*, eight_wide.children>;

SlottedChildren place_children(const WideNode& node, Double3 node_centre)
{
    std::vector<Double3> offsets;
    for (const auto& child : node)
        offsets.push_back(centre(child.box) - node_centre);
    const auto slots = octant_slots(offsets);
    SlottedChildren placed = {};
    for (std::size_t i = 0; i < node.size(); ++i)
        placed[slots[i]] = &node[i];
    return placed;
}

void set_grid(CwbvhNode& node, const BoxGrid& grid)
{
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.words[axis] = std::bit_cast<std::uint32_t>(grid.origin[static_cast<int>(axis)]);
        node.set_byte(CwbvhNode::grid_word, axis, grid.exponent[axis]);
    }
}

// An empty slot has the box that no ray meets.
void set_boxes(CwbvhNode& node, const BoxGrid& grid, const SlottedChildren& children)
{
    for (std::size_t slot = 0; slot < eight_wide.children; ++slot) {
        const GridBox box =
            children[slot] != nullptr ? to_grid(grid, grown_box(*children[slot])) : GridBox{{255, 255, 255}, {0, 0, 0}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.set_byte(CwbvhNode::low + 2 * axis, slot, box.low[axis]);
            node.set_byte(CwbvhNode::high + 2 * axis, slot, box.high[axis]);
        }
    }
}

class CwbvhPacker {
public:
    CwbvhPacker(const TriangleMesh& mesh, const WideBvh& wide) : mesh_(mesh), wide_(wide) {}

    PackedScene pack()
    {
        packed_.nodes.resize(CWBVH_NODE_QUADS);
        packed_.stack_entries = 1; // an array has one
        pack_node(wide_.nodes.front(), 0, 0);
        return std::move(packed_);
    }

private:
    // Children of a node are stored together; their subtrees follow, one child after the other.
    // waiting: nodes above this one of whose hits some may wait on a ray's stack.
    void pack_node(const WideNode& wide, std::uint32_t index, std::uint32_t waiting)
    {
        Box box;
        for (const auto& child : wide)
            box = merged(box, grown_box(child));
        const BoxGrid grid = make_box_grid(box);
        const SlottedChildren children = place_children(wide, centre(box));
        CwbvhNode node;
        set_grid(node, grid);
        set_boxes(node, grid, children);
        const auto first_child = static_cast<std::uint32_t>(packed_.nodes.size() / CWBVH_NODE_QUADS);
        node.words[CwbvhNode::child_base] = first_child;
        const std::uint32_t inner = set_inner(node, children);
        set_leaves(node, children);
        packed_.nodes.resize(packed_.nodes.size() + std::size_t{inner} * CWBVH_NODE_QUADS);
        node.append_to(packed_.nodes, std::size_t{index} * CWBVH_NODE_QUADS);
        if (inner > 1) ++waiting;
        packed_.stack_entries = std::max(packed_.stack_entries, waiting);

        std::uint32_t next = first_child;
        for (const auto* child : children)
            if (child != nullptr && child->count == 0) pack_node(wide_.nodes[child->node], next++, waiting);
    }

    static std::uint32_t set_inner(CwbvhNode& node, const SlottedChildren& children)
    {
        std::uint32_t inner = 0;
        for (std::uint32_t slot = 0; slot < eight_wide.children; ++slot) {
            if (children[slot] == nullptr || children[slot]->count > 0) continue;
            node.words[CwbvhNode::grid_word] |= 1u << (24 + slot);
            node.set_byte(CwbvhNode::meta, slot, 0x20 | (24 + slot));
            ++inner;
        }
        return inner;
    }

    void set_leaves(CwbvhNode& node, const SlottedChildren& children)
    {
        const std::uint32_t first = add_leaf_triangles(packed_, mesh_, {});
        node.words[CwbvhNode::triangle_base] = first;
        for (std::uint32_t slot = 0; slot < eight_wide.children; ++slot) {
            if (children[slot] == nullptr || children[slot]->count == 0) continue;
            const auto triangles = triangles_of_leaf(wide_, *children[slot]);
            const std::uint32_t offset = add_leaf_triangles(packed_, mesh_, triangles) - first;
            const std::uint32_t unary = (1u << triangles.size()) - 1;
            node.set_byte(CwbvhNode::meta, slot, unary << 5 | offset);
        }
    }

    const TriangleMesh& mesh_;
    const WideBvh& wide_;
    PackedScene packed_;
};

} // namespace

PackedScene pack_cwbvh(const TriangleMesh& mesh, const Bvh& bvh)
{
    constexpr std::uint32_t max_depth = 3 * CWBVH_STACK; // three binary levels make one level of eight children
    if (const auto depth = depth_of(bvh); depth > max_depth)
        refuse_to_pack(Layout::cwbvh, depth, "inner nodes above a leaf", max_depth);
    const Bvh binary = with_single_leaves(mesh, bvh);
    WideBvh wide = make_wide(binary, eight_wide, Collapse::cheapest);
    std::string fall_back;
    if (const auto levels = levels_of(wide); levels > CWBVH_STACK) {
        wide = make_wide(binary, eight_wide, Collapse::shallow);
        fall_back = "three binary levels are one of eight children: the cheapest nodes would be " +
                    std::to_string(levels) + " deep, but a ray's stack holds " + std::to_string(CWBVH_STACK);
    }
    if (const auto levels = levels_of(wide); levels > CWBVH_STACK)
        refuse_to_pack(Layout::cwbvh, levels, "pairs would wait on a ray's stack", CWBVH_STACK);
    PackedScene packed = CwbvhPacker(mesh, wide).pack();
    packed.fall_back = std::move(fall_back);
    return packed;
}

} // namespace tetrace
