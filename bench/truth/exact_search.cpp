#include "bench/truth/exact_search.h"

#include "bench/truth/hit_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace tetrace {
namespace {

// More than double precision loses in a sum of products, each of which is at most that large: 4e-15 is 36 units of
// 2^-53, and no sum here has more than 12 roundings.
constexpr double lost_share = 4e-15;
constexpr double box_slack = 1e-9; // of coordinates below 2^7, whose slab distances are right to 2^-44
constexpr double nowhere = std::numeric_limits<double>::infinity();

double sum_of(Double3 a)
{
    return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}

} // namespace

// Binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
struct ExactSearch::Builder {
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

    explicit Builder(ExactSearch& made) : search(made), boxes(made.mesh_.triangles.size())
    {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (const std::uint32_t v : search.mesh_.triangles[i]) {
                const Float3 p = search.mesh_.vertices[v];
                boxes[i].add({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
            }
        search.order_.resize(boxes.size());
        std::iota(search.order_.begin(), search.order_.end(), 0u);
        search.nodes_.resize(1);
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
        std::copy(box.low.begin(), box.low.end(), search.nodes_[node].low);
        std::copy(box.high.begin(), box.high.end(), search.nodes_[node].high);
        search.nodes_[node].first = range.first;
        search.nodes_[node].count = range.second - range.first;
        if (search.nodes_[node].count <= leaf_size) return;

        const std::uint32_t middle = split(range, middles, depth);
        const auto children = static_cast<std::uint32_t>(search.nodes_.size());
        search.nodes_.resize(children + 2);
        search.nodes_[node].first = children;
        search.nodes_[node].count = 0;
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
        const auto begin = search.order_.begin() + range.first, end = search.order_.begin() + range.second;
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
            const auto bin = static_cast<std::size_t>(bin_of(search.order_[i]));
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
        double least = nowhere;
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

    [[nodiscard]] const Box& box_at(std::uint32_t i) const { return boxes[search.order_[i]]; }

    ExactSearch& search;
    std::vector<Box> boxes;
};

// The points within a radius of a part of a ray.
struct ExactSearch::Tube {
    Tube(const ExactRay& ray, double wide, double last)
        : origin(to_double(ray.origin)), direction(to_double(ray.direction)), radius(wide),
          grown(wide * (1 + 1e-6) + box_slack), end(last)
    {
        for (int axis = 0; axis < 3; ++axis)
            inverse[axis] = 1 / (ray.direction[axis] == 0 ? 1e-300 : static_cast<double>(ray.direction[axis]));
    }

    // Where the tube's line enters a box that is grown by its radius; `nowhere` where it does not.
    [[nodiscard]] double entry(const Node& node) const
    {
        const double from[3] = {origin.x, origin.y, origin.z};
        double near = 0, far = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (static_cast<double>(node.low[axis]) - grown - from[axis]) * inverse[axis];
            const double b = (static_cast<double>(node.high[axis]) + grown - from[axis]) * inverse[axis];
            near = std::max(near, a < b ? a : b);
            far = std::min(far, a < b ? b : a);
        }
        return near <= far * (1 + 1e-12) ? near : nowhere;
    }

    // A triangle's position, as the tube's line sees it.
    struct Seen {
        Double3 a, b, c; // its corners from the origin: exact, as all coordinates are on the grid
        bool is_outside; // by more than the radius
        bool covers;     // the tube's cross-section
    };
    [[nodiscard]] Seen seen(const TriangleMesh& mesh, std::uint32_t triangle) const
    {
        const auto& [i, j, k] = mesh.triangles[triangle];
        Seen seen{to_double(mesh.vertices[i]) - origin, to_double(mesh.vertices[j]) - origin,
                  to_double(mesh.vertices[k]) - origin, false, false};
        double low = nowhere, high = -nowhere, inside = nowhere, inside_other = nowhere;
        for (const auto& [p, q] : {std::pair{seen.a, seen.b}, {seen.b, seen.c}, {seen.c, seen.a}}) {
            const double side = dot(direction, cross(p, q));
            const double margin =
                radius * (1 + 1e-9) * length(cross(direction, q - p)) + lost_share * sum * sum_of(p) * sum_of(q);
            low = std::min(low, side + margin);
            high = std::max(high, side - margin);
            inside = std::min(inside, side - margin);
            inside_other = std::min(inside_other, -side - margin);
        }
        seen.is_outside = low < 0 && high > 0; // whichever way the triangle faces
        seen.covers = inside > 0 || inside_other > 0;
        return seen;
    }
    // Ray parameter of the point of the line that is nearest to a point.
    [[nodiscard]] double depth(Double3 from_origin) const { return dot(from_origin, direction) / (speed * speed); }

    Double3 origin, direction;
    double radius, grown, end; // end: ray parameter
    double speed = length(direction), sum = sum_of(direction);
    double inverse[3];
};

template <class Visit>
void ExactSearch::visit(Tube& tube, const Visit& visit) const
{
    struct Waiting {
        std::uint32_t node;
        double entry;
    };
    std::array<Waiting, 128> waiting;
    std::size_t count = 0;
    if (!order_.empty() && tube.entry(nodes_[0]) < nowhere) waiting[count++] = {0, 0};
    while (count > 0) {
        const auto [number, entry] = waiting[--count];
        if (entry > tube.end * (1 + 1e-12)) continue;
        const Node& node = nodes_[number];
        if (node.count > 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                visit(order_[i]);
            continue;
        }
        const double left = tube.entry(nodes_[node.first]), right = tube.entry(nodes_[node.first + 1]);
        const std::uint32_t nearer = left <= right ? 0 : 1;
        if (std::max(left, right) < nowhere) waiting[count++] = {node.first + 1 - nearer, std::max(left, right)};
        if (std::min(left, right) < nowhere) waiting[count++] = {node.first + nearer, std::min(left, right)};
    }
}

// The nearest triangle that covers the tube's cross-section, and those that may reach into the tube before it.
class ExactSearch::Nearest {
public:
    Nearest(const TriangleMesh& mesh, const ExactRay& ray, const RayPart& part, Tube& tube)
        : mesh_(mesh), ray_(ray), part_(part), tube_(tube)
    {
    }

    void test(std::uint32_t triangle)
    {
        if (triangle == part_.start) return;
        const auto [a, b, c, is_outside, covers] = tube_.seen(mesh_, triangle);
        if (is_outside) return;
        if (!covers) {
            keep(std::min({tube_.depth(a), tube_.depth(b), tube_.depth(c)}));
            return;
        }
        const Double3 e1 = b - a, e2 = c - a, normal = cross(e1, e2);
        const double determinant = dot(tube_.direction, normal);
        const double t = dot(a, normal) / determinant;
        const double error =
            lost_share * sum_of(e1) * sum_of(e2) * (sum_of(a) + std::abs(t) * tube_.sum) / std::abs(determinant);
        const double reach =
            (tube_.radius / tube_.speed) * (1 + length(normal) * tube_.speed / std::abs(determinant)) + error;
        if (t + reach < 0 || is_beyond_end(triangle, t)) return;
        if (t - reach <= 0 || is_at_end(triangle, t)) {
            keep(t - reach);
            return;
        }
        if (t + error < t_ - error_) {
            take(triangle, t, error, reach);
        } else if (t - error <= t_ + error_) {
            keep(t - reach);
        }
    }

    [[nodiscard]] FirstHit result() const { return {best_, nearest_other_ > tube_.end || nearest_other_ == nowhere}; }

private:
    // The end is compared with a rounded t.
    [[nodiscard]] bool is_beyond_end(std::uint32_t triangle, double t) const
    {
        return part_.has_end() && t > static_cast<double>(part_.end) + end_error(triangle);
    }
    [[nodiscard]] bool is_at_end(std::uint32_t triangle, double t) const
    {
        return part_.has_end() && t >= static_cast<double>(part_.end) - end_error(triangle);
    }
    [[nodiscard]] double end_error(std::uint32_t triangle) const
    {
        return end_error_of(mesh_, ray_, triangle, tube_.radius);
    }

    void take(std::uint32_t triangle, double t, double error, double reach)
    {
        best_ = triangle;
        t_ = t;
        error_ = error;
        tube_.end = t + reach; // of the part: nothing past the triangle's far end in the tube is needed
    }
    void keep(double from) { nearest_other_ = std::min(nearest_other_, from - tube_.radius / tube_.speed); }

    const TriangleMesh& mesh_;
    const ExactRay& ray_;
    const RayPart& part_;
    Tube& tube_;
    std::uint32_t best_ = NO_HIT;
    double t_ = nowhere, error_ = 0;
    double nearest_other_ = nowhere; // the least depth of the others
};

ExactSearch::ExactSearch(const TriangleMesh& mesh) : mesh_(mesh)
{
    Builder{*this};
}

namespace {

double last_of(const RayPart& part)
{
    // Past the end by far more than t can be off: a triangle there may be within its error of the end.
    return part.has_end() ? static_cast<double>(part.end) * 1.0625 + 0.0625 : nowhere;
}

} // namespace

FirstHit ExactSearch::first(const ExactRay& ray, const RayPart& part, double radius) const
{
    Tube tube(ray, radius, last_of(part));
    Nearest nearest(mesh_, ray, part, tube);
    visit(tube, [&](std::uint32_t triangle) { nearest.test(triangle); });
    return nearest.result();
}

std::vector<std::uint32_t> ExactSearch::within(const ExactRay& ray, const RayPart& part, double radius) const
{
    std::vector<std::uint32_t> found;
    Tube tube(ray, radius, last_of(part));
    visit(tube, [&](std::uint32_t triangle) {
        if (triangle != part.start && !tube.seen(mesh_, triangle).is_outside) found.push_back(triangle);
    });
    std::ranges::sort(found);
    return found;
}

} // namespace tetrace
