#include "core/bvh/bvh.h"

#include <numeric>
#include <span>

namespace tetrace {

namespace {

using Defect = std::optional<std::string>;

std::string node_text(std::size_t node)
{
    return "node " + std::to_string(node) + ' ';
}

Defect child_defect(const Bvh& bvh, std::size_t parent, std::vector<bool>& is_child)
{
    for (const auto child : bvh.nodes[parent].child) {
        if (child <= parent || child >= bvh.nodes.size())
            return node_text(parent) + "has a child before it or past "
                                       "the last node";
        if (is_child[child]) return node_text(child) + "is a child twice";
        is_child[child] = true;
        if (!contains(bvh.nodes[parent].box, bvh.nodes[child].box))
            return node_text(child) + "has a box that is not in its parent's";
    }
    return {};
}

/// The references of a bvh as its leaves have them.
struct BvhCoverage {
    std::vector<bool> referred;   ///< by a leaf
    std::vector<Box> of_triangle; ///< the boxes of its leaves, merged
};

Defect leaf_defect(const Bvh& bvh, std::size_t leaf, BvhCoverage& coverage)
{
    const auto& [box, child, first, count] = bvh.nodes[leaf];
    if (std::uint64_t{first} + count > bvh.references.size()) return node_text(leaf) + "has references past the last";
    for (std::size_t i = first; i < std::size_t{first} + count; ++i) {
        const std::uint32_t triangle = bvh.references[i];
        if (coverage.referred[i]) return "reference " + std::to_string(i) + " is in two leaves";
        coverage.referred[i] = true;
        if (triangle >= coverage.of_triangle.size()) return node_text(leaf) + "names a triangle past the last";
        for (std::size_t j = first; j < i; ++j)
            if (bvh.references[j] == triangle) return node_text(leaf) + "names a triangle twice";
        coverage.of_triangle[triangle] = merged(coverage.of_triangle[triangle], box);
    }
    return {};
}

Defect coverage_defect(const BvhCoverage& coverage, const TriangleMesh& mesh)
{
    for (std::size_t i = 0; i < coverage.referred.size(); ++i)
        if (!coverage.referred[i]) return "reference " + std::to_string(i) + " is in no leaf";
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (!contains(coverage.of_triangle[i], triangle_box(mesh, i)))
            return "triangle " + std::to_string(i) + " is not covered by the boxes of its leaves";
    return {};
}

} // namespace

std::uint32_t depth_of(const Bvh& bvh)
{
    std::vector<std::uint32_t> depth(bvh.nodes.size());
    std::uint32_t deepest = 0;
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        deepest = std::max(deepest, depth[i]);
        if (bvh.nodes[i].count == 0)
            for (const auto child : bvh.nodes[i].child)
                depth[child] = depth[i] + 1;
    }
    return deepest;
}

std::optional<std::string> find_defect(const Bvh& bvh, const TriangleMesh& mesh)
{
    if (bvh.nodes.empty()) return "the root is missing";
    std::vector<bool> is_child(bvh.nodes.size());
    BvhCoverage coverage{std::vector<bool>(bvh.references.size()), std::vector<Box>(mesh.triangles.size())};
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        auto defect = bvh.nodes[i].count == 0 ? child_defect(bvh, i, is_child) : leaf_defect(bvh, i, coverage);
        if (defect) return defect;
        if (i > 0 && !is_child[i]) return node_text(i) + "is nobody's child";
    }
    return coverage_defect(coverage, mesh);
}

namespace {

constexpr std::size_t max_balanced_leaf = 4; // triangles

class BalancedBuilder {
public:
    explicit BalancedBuilder(const TriangleMesh& mesh) : boxes_(mesh.triangles.size())
    {
        for (std::size_t i = 0; i < boxes_.size(); ++i)
            boxes_[i] = triangle_box(mesh, i);
        bvh_.references.resize(boxes_.size());
        std::iota(bvh_.references.begin(), bvh_.references.end(), 0u);
    }

    Bvh build()
    {
        add(0, bvh_.references.size());
        return std::move(bvh_);
    }

private:
    std::uint32_t add(std::size_t first, std::size_t count)
    {
        const auto node = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes.emplace_back();
        if (count <= max_balanced_leaf) {
            bvh_.nodes[node].first = static_cast<std::uint32_t>(first);
            bvh_.nodes[node].count = static_cast<std::uint32_t>(count);
            for (std::size_t i = first; i < first + count; ++i)
                bvh_.nodes[node].box = merged(bvh_.nodes[node].box, boxes_[bvh_.references[i]]);
            return node;
        }
        halve(std::span(bvh_.references).subspan(first, count));
        const std::uint32_t left = add(first, count / 2);
        const std::uint32_t right = add(first + count / 2, count - count / 2);
        bvh_.nodes[node].child = {left, right};
        bvh_.nodes[node].box = merged(bvh_.nodes[left].box, bvh_.nodes[right].box);
        return node;
    }

    void halve(std::span<std::uint32_t> triangles) const
    {
        Box centres;
        for (const auto i : triangles)
            centres = merged(centres, {to_float(centre(boxes_[i])), to_float(centre(boxes_[i]))});
        const Double3 size = to_double(centres.high) - to_double(centres.low);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto key = [&](std::uint32_t i) {
            return std::pair(boxes_[i].low[axis] + boxes_[i].high[axis],
                             i); // equal ones by number: one order everywhere
        };
        std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2),
                         triangles.end(), [&](auto a, auto b) { return key(a) < key(b); });
    }

    std::vector<Box> boxes_;
    Bvh bvh_;
};

} // namespace

Bvh build_balanced_bvh(const TriangleMesh& mesh)
{
    return BalancedBuilder(mesh).build();
}

namespace {

/// The point where an edge crosses the plane, as a box: one corner is rounded down, the other up.
Box crossing(Double3 from, Double3 to, int axis, double position)
{
    const double coordinates[2][3] = {{from.x, from.y, from.z}, {to.x, to.y, to.z}};
    const double t = (position - coordinates[0][axis]) / (coordinates[1][axis] - coordinates[0][axis]);
    Box box;
    for (int i = 0; i < 3; ++i) {
        const double x = i == axis ? position : coordinates[0][i] + t * (coordinates[1][i] - coordinates[0][i]);
        const double error = i == axis ? 0 : 0x1p-50 * (std::abs(coordinates[0][i]) + std::abs(coordinates[1][i]));
        box.low[i] = float_below(x - error);
        box.high[i] = float_above(x + error);
    }
    return box;
}

} // namespace

TriangleParts split_triangle(const Float3 (&corners)[3], int axis, float position, const Box& box)
{
    TriangleParts parts;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float3 from = corners[i];
        const Float3 to = corners[(i + 1) % 3];
        if (from[axis] <= position) parts.below = merged(parts.below, {from, from});
        if (from[axis] >= position) parts.above = merged(parts.above, {from, from});
        if ((from[axis] < position && to[axis] > position) || (from[axis] > position && to[axis] < position)) {
            const Box point = crossing(to_double(from), to_double(to), axis, position);
            parts.below = merged(parts.below, point);
            parts.above = merged(parts.above, point);
        }
    }
    return {common(parts.below, box), common(parts.above, box)};
}

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
