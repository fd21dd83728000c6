#include "bench/truth/exact_search.h"

#include "bench/truth/hit_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    [[nodiscard]] double entry(const BoxTree::Node& node) const
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
void ExactSearch::visit(const Tube& tube, const Visit& visit) const
{
    tree_.visit([&](const BoxTree::Node& node) { return tube.entry(node); },
                [&](double entry) { return entry > tube.end * (1 + 1e-12); }, visit);
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
