#include "core/bvh/wide_bvh.h"

namespace tetrace {
namespace {

/// The least costs of a subtree as at most 1, 2, ... children of a wide node, one fewer than the node has, and as a
/// node of its own.
struct SubtreePlan {
    std::array<double, max_wide_children> cost = {}; ///< as at most i children; [0] is not used
    std::array<std::uint8_t, max_wide_children + 1> share =
        {};                             ///< of i children that the left child gets; 0: i - 1 are best
    bool is_leaf = false;               ///< as one child
    std::uint32_t first = 0, count = 0; ///< references below
};

class WideBvhMaker {
public:
    WideBvhMaker(const Bvh& bvh, const WideShape& shape, Collapse collapse)
        : bvh_(bvh), shape_(shape), collapse_(collapse), plans_(bvh.nodes.size())
    {
        for (std::size_t i = bvh.nodes.size(); i-- > 0;)
            bvh.nodes[i].count > 0 ? plan_leaf(i) : plan_inner(i);
    }

    WideBvh make()
    {
        wide_.references = bvh_.references;
        std::vector<std::uint32_t> children;
        if (bvh_.nodes.front().count > 0)
            children.push_back(0);
        else
            open(0, shape_.children, children);
        add_node(children);
        return std::move(wide_);
    }

private:
    [[nodiscard]] double leaf_cost(std::size_t node) const
    {
        return half_area(bvh_.nodes[node].box) * plans_[node].count * wide_triangle_cost;
    }

    void plan_leaf(std::size_t node)
    {
        SubtreePlan& plan = plans_[node];
        plan.first = bvh_.nodes[node].first;
        plan.count = bvh_.nodes[node].count;
        plan.is_leaf = true;
        plan.cost.fill(leaf_cost(node));
    }

    void plan_inner(std::size_t node)
    {
        SubtreePlan& plan = plans_[node];
        const auto& left = plans_[bvh_.nodes[node].child[0]];
        const auto& right = plans_[bvh_.nodes[node].child[1]];
        plan.first = left.first;
        plan.count = left.count + right.count;
        plan.cost[1] = share_out(plan, left, right, shape_.children) + half_area(bvh_.nodes[node].box) * wide_node_cost;
        if (plan.count <= shape_.leaf_triangles &&
            (leaf_cost(node) <= plan.cost[1] || collapse_ == Collapse::shallow)) {
            plan.is_leaf = true;
            plan.cost[1] = leaf_cost(node);
        }
        for (std::size_t i = 2; i < shape_.children; ++i) {
            plan.cost[i] = share_out(plan, left, right, i);
            if (plan.cost[i] < plan.cost[i - 1] || collapse_ == Collapse::shallow) continue;
            plan.cost[i] = plan.cost[i - 1];
            plan.share[i] = 0;
        }
    }

    // Divides `children` between left and right; returns the cost.
    double share_out(SubtreePlan& plan, const SubtreePlan& left, const SubtreePlan& right, std::size_t children) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 1; k < children; ++k) {
            if (collapse_ == Collapse::shallow && k != children / 2) continue;
            const double cost = left.cost[k] + right.cost[children - k];
            if (cost < least) {
                least = cost;
                plan.share[children] = static_cast<std::uint8_t>(k);
            }
        }
        return least;
    }

    // The node's two subtrees as `budget` children.
    void open(std::uint32_t node, std::size_t budget, std::vector<std::uint32_t>& children) const
    {
        const std::size_t share = plans_[node].share[budget];
        add_children(bvh_.nodes[node].child[0], share, children);
        add_children(bvh_.nodes[node].child[1], budget - share, children);
    }

    void add_children(std::uint32_t node, std::size_t budget, std::vector<std::uint32_t>& children) const
    {
        while (budget > 1 && plans_[node].share[budget] == 0)
            --budget;
        if (budget == 1)
            children.push_back(node);
        else
            open(node, budget, children);
    }

    std::uint32_t add_node(const std::vector<std::uint32_t>& children)
    {
        const auto added = static_cast<std::uint32_t>(wide_.nodes.size());
        wide_.nodes.emplace_back();
        for (const auto child : children) {
            const WideChild wide = make_child(child);
            wide_.nodes[added].push_back(wide);
        }
        return added;
    }

    WideChild make_child(std::uint32_t node)
    {
        const SubtreePlan& plan = plans_[node];
        if (plan.is_leaf) return {bvh_.nodes[node].box, 0, plan.first, plan.count};
        std::vector<std::uint32_t> children;
        open(node, shape_.children, children);
        return {bvh_.nodes[node].box, add_node(children), 0, 0};
    }

    const Bvh& bvh_;
    WideShape shape_;
    Collapse collapse_;
    std::vector<SubtreePlan> plans_;
    WideBvh wide_;
};

} // namespace

WideBvh make_wide(const Bvh& bvh, const WideShape& shape, Collapse collapse)
{
    return WideBvhMaker(bvh, shape, collapse).make();
}

std::uint32_t levels_of(const WideBvh& bvh)
{
    std::vector<std::uint32_t> levels(bvh.nodes.size(), 1);
    std::uint32_t most = 0;
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        most = std::max(most, levels[i]);
        for (const auto& child : bvh.nodes[i])
            if (child.count == 0) levels[child.node] = levels[i] + 1;
    }
    return most;
}

} // namespace tetrace
