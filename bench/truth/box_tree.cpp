#include "bench/truth/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tetrace {

// Binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
struct BoxTree::Builder {
    static constexpr std::uint32_t leaf_size = 4;
    static constexpr int bins = 16;
    static constexpr int deepest = 60; // below, halves: the stack of visit() holds both

    struct Box {
        std::array<float, 3> low{HUGE_VALF, HUGE_VALF, HUGE_VALF}, high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

        void add(const Box& other)
        {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], other.low[axis]);
                high[axis] = std::max(high[axis], other.high[axis]);
            }
        }
        [[nodiscard]] float middle(std::size_t axis) const { return low[axis] + high[axis]; } // twice the middle
        [[nodiscard]] double area() const
        {
            const double x = double{high[0]} - double{low[0]}, y = double{high[1]} - double{low[1]},
                         z = double{high[2]} - double{low[2]};
            return x < 0 ? 0 : x * y + y * z + z * x;
        }
    };
    using Range = std::pair<std::uint32_t, std::uint32_t>;

    Builder(BoxTree& made, const TriangleMesh& mesh) : tree(made), boxes(mesh.triangles.size())
    {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (const std::uint32_t v : mesh.triangles[i]) {
                const Float3 p = mesh.vertices[v];
                boxes[i].add({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
            }
        tree.order_.resize(boxes.size());
        std::iota(tree.order_.begin(), tree.order_.end(), 0u);
        tree.nodes_.resize(1);
        if (!boxes.empty()) build(0, {0, static_cast<std::uint32_t>(boxes.size())}, 0);
    }

    void build(std::size_t node, Range range, int depth)
    {
        Box box, middles;
        for (std::uint32_t i = range.first; i < range.second; ++i) {
            const Box& one = box_at(i);
            box.add(one);
            const std::array<float, 3> middle{one.middle(0), one.middle(1), one.middle(2)};
            middles.add({middle, middle});
        }
        std::copy(box.low.begin(), box.low.end(), tree.nodes_[node].low);
        std::copy(box.high.begin(), box.high.end(), tree.nodes_[node].high);
        tree.nodes_[node].first = range.first;
        tree.nodes_[node].count = range.second - range.first;
        if (tree.nodes_[node].count <= leaf_size) return;

        const std::uint32_t middle = split(range, middles, depth);
        const auto children = static_cast<std::uint32_t>(tree.nodes_.size());
        tree.nodes_.resize(children + 2);
        tree.nodes_[node].first = children;
        tree.nodes_[node].count = 0;
        build(children, {range.first, middle}, depth + 1);
        build(children + 1, {middle, range.second}, depth + 1);
    }

    // Orders the range, and returns where its second part begins.
    std::uint32_t split(Range range, const Box& middles, int depth)
    {
        std::size_t axis = 0;
        for (std::size_t other = 1; other < 3; ++other)
            if (middles.high[other] - middles.low[other] > middles.high[axis] - middles.low[axis]) axis = other;
        const float low = middles.low[axis], extent = middles.high[axis] - low;
        const auto begin = tree.order_.begin() + range.first, end = tree.order_.begin() + range.second;
        const auto bin_of = [&](std::uint32_t triangle) {
            return std::min(bins - 1, static_cast<int>(bins * ((boxes[triangle].middle(axis) - low) / extent)));
        };
        if (extent > 0 && depth < deepest) {
            const int best = best_bin(range, bin_of);
            const auto middle = std::partition(begin, end, [&](std::uint32_t i) { return bin_of(i) < best; });
            if (middle != begin && middle != end) return range.first + static_cast<std::uint32_t>(middle - begin);
        }
        const auto half = begin + (range.second - range.first) / 2;
        std::nth_element(begin, half, end, [&](std::uint32_t a, std::uint32_t b) {
            return boxes[a].middle(axis) < boxes[b].middle(axis);
        });
        return range.first + static_cast<std::uint32_t>(half - begin);
    }

    template <class BinOf>
    int best_bin(Range range, const BinOf& bin_of) const
    {
        std::array<Box, bins> box;
        std::array<double, bins> count{};
        for (std::uint32_t i = range.first; i < range.second; ++i) {
            const auto bin = static_cast<std::size_t>(bin_of(tree.order_[i]));
            box[bin].add(box_at(i));
            count[bin] += 1;
        }
        std::array<double, bins> after{}; // cost of bins from here on
        Box joined;
        double counted = 0;
        for (std::size_t bin = bins; bin-- > 1;) {
            joined.add(box[bin]);
            counted += count[bin];
            after[bin] = joined.area() * counted;
        }
        joined = {};
        counted = 0;
        double least = std::numeric_limits<double>::infinity();
        int best = bins / 2;
        for (std::size_t bin = 1; bin < bins; ++bin) {
            joined.add(box[bin - 1]);
            counted += count[bin - 1];
            const double cost = joined.area() * counted + after[bin];
            if (cost >= least) continue;
            least = cost;
            best = static_cast<int>(bin);
        }
        return best;
    }

    [[nodiscard]] const Box& box_at(std::uint32_t i) const { return boxes[tree.order_[i]]; }

    BoxTree& tree;
    std::vector<Box> boxes;
};

BoxTree::BoxTree(const TriangleMesh& mesh)
{
    Builder{*this, mesh};
}

} // namespace tetrace
