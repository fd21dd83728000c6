#include "core/bvh/single_leaves.h"

#include <span>

namespace tetrace {
namespace {

/// A leaf's part of a triangle.
struct TrianglePart {
    Box box;
    std::uint32_t triangle = 0;
};

Box box_round(std::span<const TrianglePart> parts)
{
    Box box;
    for (const auto& part : parts)
        box = merged(box, part.box);
    return box;
}

void sort_by_centre(std::span<TrianglePart> parts, int axis)
{
    std::ranges::sort(parts, [&](const auto& a, const auto& b) {
        return std::pair(a.box.low[axis] + a.box.high[axis], a.triangle) <
               std::pair(b.box.low[axis] + b.box.high[axis], b.triangle);
    });
}

/// Sorts the parts, and returns after how many of them the best split is.
std::size_t best_split(std::span<TrianglePart> parts)
{
    double least = std::numeric_limits<double>::infinity();
    int best_axis = 0;
    std::size_t best = parts.size() / 2;
    for (int axis = 0; axis < 3; ++axis) {
        sort_by_centre(parts, axis);
        for (std::size_t i = 1; i < parts.size(); ++i) {
            const double cost = half_area(box_round(parts.first(i))) * static_cast<double>(i) +
                                half_area(box_round(parts.subspan(i))) * static_cast<double>(parts.size() - i);
            if (cost < least) {
                least = cost;
                best_axis = axis;
                best = i;
            }
        }
    }
    sort_by_centre(parts, best_axis);
    return best;
}

class LeafSplitter {
public:
    LeafSplitter(const TriangleMesh& mesh, const Bvh& bvh) : mesh_(mesh), bvh_(bvh) {}

    Bvh split()
    {
        add(0);
        return std::move(result_);
    }

private:
    std::uint32_t add(std::uint32_t index)
    {
        const BvhNode& node = bvh_.nodes[index];
        if (node.count > 0) return add_leaf(node);
        const std::uint32_t added = add_node(node.box);
        for (const std::size_t i : {0u, 1u}) {
            const std::uint32_t child = add(node.child[i]);
            result_.nodes[added].child[i] = child;
        }
        return added;
    }

    std::uint32_t add_leaf(const BvhNode& leaf)
    {
        std::vector<TrianglePart> parts;
        for (const auto triangle : std::span(bvh_.references).subspan(leaf.first, leaf.count))
            parts.push_back({common(leaf.box, triangle_box(mesh_, triangle)), triangle});
        return add_parts(parts);
    }

    std::uint32_t add_parts(std::span<TrianglePart> parts)
    {
        const std::uint32_t added = add_node(box_round(parts));
        if (parts.size() == 1) {
            result_.nodes[added].first = static_cast<std::uint32_t>(result_.references.size());
            result_.nodes[added].count = 1;
            result_.references.push_back(parts.front().triangle);
            return added;
        }
        const std::size_t split = best_split(parts);
        const std::uint32_t left = add_parts(parts.first(split));
        const std::uint32_t right = add_parts(parts.subspan(split));
        result_.nodes[added].child = {left, right};
        return added;
    }

    std::uint32_t add_node(const Box& box)
    {
        result_.nodes.emplace_back();
        result_.nodes.back().box = box;
        return static_cast<std::uint32_t>(result_.nodes.size() - 1);
    }

    const TriangleMesh& mesh_;
    const Bvh& bvh_;
    Bvh result_;
};

} // namespace

Bvh with_single_leaves(const TriangleMesh& mesh, const Bvh& bvh)
{
    return LeafSplitter(mesh, bvh).split();
}

} // namespace tetrace
