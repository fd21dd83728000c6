#include "core/bvh/wide_bvh.h"

#include "backends/embree/bvh_builder.h"
#include "core/bvh/bvh.h"
#include "scenes/procedural.h"
#include "tests/support/bvh_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Bvh single_leaves_of(const TriangleMesh& mesh)
{
    return with_single_leaves(mesh, build_bvh(mesh).bvh);
}

} // namespace

TEST(SingleLeaves, the_tree_stays_whole_and_its_leaves_have_one_triangle)
{
    const TriangleMesh mesh = needles(500);
    const Bvh before = build_bvh(mesh).bvh;
    const Bvh bvh = with_single_leaves(mesh, before);
    EXPECT_EQ(find_defect(bvh, mesh), std::nullopt);
    EXPECT_EQ(bvh.references.size(), before.references.size());
    std::uint32_t next = 0;
    for (const auto& node : bvh.nodes) {
        if (node.count == 0) continue;
        EXPECT_EQ(node.count, 1u);
        EXPECT_EQ(node.first, next++) << "references are in the order of the leaves";
    }
}

TEST(SingleLeaves, a_leaf_is_split_where_it_costs_least)
{
    TriangleMesh mesh;
    for (const float x : {0.0f, 1.0f, 0.01f, 1.01f})
        add_triangle(mesh, {x, 0, 0}, {x, 0.1f, 0}, {x, 0, 0.1f});
    Bvh leaf;
    leaf.references = {0, 1, 2, 3};
    leaf.nodes.push_back({{{0, 0, 0}, {1.01f, 0.1f, 0.1f}}, {}, 0, 4});
    const Bvh bvh = with_single_leaves(mesh, leaf);
    EXPECT_EQ(find_defect(bvh, mesh), std::nullopt);
    EXPECT_EQ(bvh.references, (std::vector<std::uint32_t>{0, 2, 1, 3}));
}

namespace {

/// A binary BVH over `count` triangles, halved at random.
class RandomTree {
public:
    RandomTree(std::uint32_t count, std::uint64_t seed) : random_(seed)
    {
        bvh.references.resize(count);
        std::iota(bvh.references.begin(), bvh.references.end(), 0u);
        add(0, count);
    }
    Bvh bvh;

private:
    std::uint32_t add(std::uint32_t first, std::uint32_t count)
    {
        const auto node = static_cast<std::uint32_t>(bvh.nodes.size());
        bvh.nodes.emplace_back();
        if (count == 1) {
            const Float3 a = random_.point(0, 1), b = random_.point(0, 1);
            bvh.nodes[node] = {merged({a, a}, {b, b}), {}, first, 1};
            return node;
        }
        const std::uint32_t share = 1 + random_.below(count - 1);
        const std::uint32_t left = add(first, share);
        const std::uint32_t right = add(first + share, count - share);
        bvh.nodes[node].child = {left, right};
        bvh.nodes[node].box = merged(bvh.nodes[left].box, bvh.nodes[right].box);
        return node;
    }
    Random random_;
};

double leaf_cost(const Box& box, std::uint32_t count)
{
    return half_area(box) * count * wide_triangle_cost;
}

/// Of all below the root: its children's nodes and leaves.
double cost_of(const WideBvh& wide)
{
    double cost = 0;
    for (const auto& node : wide.nodes)
        for (const auto& child : node)
            cost += child.count > 0 ? leaf_cost(child.box, child.count) : half_area(child.box) * wide_node_cost;
    return cost;
}

/// Least costs by trying every way: a second opinion on the dynamic programme.
class EveryWay {
public:
    EveryWay(const Bvh& bvh, const WideShape& shape) : bvh_(bvh), shape_(shape) {}

    double below(std::uint32_t node) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [children, cost] : cuts(bvh_.nodes[node].child[0]))
            for (const auto& [others, other_cost] : cuts(bvh_.nodes[node].child[1]))
                if (children + others <= shape_.children) least = std::min(least, cost + other_cost);
        return least;
    }

private:
    struct Cut {
        std::size_t children;
        double cost;
    };

    std::uint32_t triangles(std::uint32_t node) const
    {
        const BvhNode& n = bvh_.nodes[node];
        return n.count > 0 ? n.count : triangles(n.child[0]) + triangles(n.child[1]);
    }

    double as_child(std::uint32_t node) const
    {
        const std::uint32_t count = triangles(node);
        const Box& box = bvh_.nodes[node].box;
        double cost = count <= shape_.leaf_triangles ? leaf_cost(box, count) : std::numeric_limits<double>::infinity();
        if (bvh_.nodes[node].count == 0) cost = std::min(cost, half_area(box) * wide_node_cost + below(node));
        return cost;
    }

    std::vector<Cut> cuts(std::uint32_t node) const
    {
        std::vector<Cut> all = {{1, as_child(node)}};
        if (bvh_.nodes[node].count > 0) return all;
        for (const auto& [children, cost] : cuts(bvh_.nodes[node].child[0]))
            for (const auto& [others, other_cost] : cuts(bvh_.nodes[node].child[1]))
                if (children + others < shape_.children) all.push_back({children + others, cost + other_cost});
        return all;
    }

    const Bvh& bvh_;
    WideShape shape_;
};

} // namespace

TEST(WideBvh, no_other_way_to_collapse_costs_less)
{
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Bvh bvh = RandomTree(11, seed).bvh;
        for (const WideShape& shape : {four_wide, eight_wide})
            EXPECT_NEAR(cost_of(make_wide(bvh, shape, Collapse::cheapest)), EveryWay(bvh, shape).below(0), 1e-9)
                << "seed " << seed << ", " << shape.children << " children";
    }
}

namespace {

void expect_whole(const Bvh& bvh, const WideShape& shape, Collapse collapse)
{
    const WideBvh wide = make_wide(bvh, shape, collapse);
    std::vector<int> seen(bvh.references.size());
    std::vector<int> is_child(wide.nodes.size());
    for (std::size_t i = 0; i < wide.nodes.size(); ++i) {
        ASSERT_GE(wide.nodes[i].size(), i == 0 ? 1u : 2u);
        ASSERT_LE(wide.nodes[i].size(), shape.children);
        for (const auto& child : wide.nodes[i]) {
            ASSERT_LE(child.count, shape.leaf_triangles);
            for (std::uint32_t k = child.first; k < child.first + child.count; ++k)
                ++seen[k];
            if (child.count > 0) continue;
            ASSERT_GT(child.node, i);
            ++is_child[child.node];
            for (const auto& grandchild : wide.nodes[child.node])
                EXPECT_TRUE(contains(child.box, grandchild.box));
        }
    }
    EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
    ++is_child[0];
    EXPECT_EQ(is_child, std::vector<int>(is_child.size(), 1));
}

} // namespace

TEST(WideBvh, each_reference_is_in_one_leaf)
{
    for (const WideShape& shape : {four_wide, eight_wide})
        for (const auto collapse : {Collapse::cheapest, Collapse::shallow}) {
            expect_whole(single_leaves_of(needles(500)), shape, collapse);
            for (std::uint32_t count = 1; count < 30; ++count)
                expect_whole(RandomTree(count, count).bvh, shape, collapse);
        }
}

TEST(WideBvh, nodes_of_a_surface_are_nearly_full)
{
    const Bvh bvh = single_leaves_of(make_cubes(10).mesh);
    for (const WideShape& shape : {four_wide, eight_wide}) {
        const WideBvh wide = make_wide(bvh, shape, Collapse::cheapest);
        std::size_t children = 0;
        for (const auto& node : wide.nodes)
            children += node.size();
        EXPECT_GT(static_cast<double>(children) / static_cast<double>(wide.nodes.size()), 0.875 * shape.children);
    }
}

TEST(WideBvh, the_shallow_one_makes_one_level_of_two_or_three)
{
    const Bvh bvh = single_leaves_of(nested_groups(1, 30, 20));
    for (const WideShape& shape : {four_wide, eight_wide}) {
        const std::uint32_t levels = levels_of(make_wide(bvh, shape, Collapse::shallow));
        const std::uint32_t binary_levels = shape.children == 4 ? 2 : 3;
        EXPECT_LE(levels, (depth_of(bvh) + binary_levels - 1) / binary_levels);
        EXPECT_LT(levels, levels_of(make_wide(bvh, shape, Collapse::cheapest)));
    }
}

TEST(WideBvh, one_leaf_becomes_a_root_with_one_child)
{
    const WideBvh wide = make_wide(single_leaves_of(identical_triangles(1)), eight_wide, Collapse::cheapest);
    ASSERT_EQ(wide.nodes.size(), 1u);
    EXPECT_EQ(wide.nodes[0].size(), 1u);
    EXPECT_EQ(levels_of(wide), 1u);
}
