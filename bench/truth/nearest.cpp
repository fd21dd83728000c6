#include "bench/truth/nearest.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace tetrace {
namespace {

using boost::multiprecision::cpp_int_backend;
using WideInteger =
    boost::multiprecision::number<cpp_int_backend<512>, boost::multiprecision::et_off>; // longer if need be

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Of sums of products of rounded differences: none here has more than 14 roundings, and this is 36 units of 2^-53.
constexpr double rounding_share = 4e-15;
// Of a distance to a box: far more than its three roundings.
constexpr double box_share = 1e-12;

double size_of(Double3 a)
{
    return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}

// The least n for which value 2^n is an integer; nothing for 0.
std::optional<int> bits_of(double value)
{
    if (value == 0) return std::nullopt;
    int exponent = 0;
    const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    return 53 - exponent - std::countr_zero(static_cast<std::uint64_t>(digits));
}

int bits_of(Double3 a, int least)
{
    for (const double value : {a.x, a.y, a.z})
        least = std::max(least, bits_of(value).value_or(least));
    return least;
}

// value 2^bits, which is an integer.
WideInteger integer_of(double value, int bits)
{
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    const WideInteger digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    const int shift = exponent - 53 + bits;
    return shift >= 0 ? WideInteger(digits << static_cast<unsigned>(shift))
                      : WideInteger(digits / (WideInteger(1) << static_cast<unsigned>(-shift)));
}

struct Wide3 {
    WideInteger x, y, z;

    friend Wide3 operator-(const Wide3& a, const Wide3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Wide3 operator+(const Wide3& a, const Wide3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Wide3 operator*(const Wide3& a, const WideInteger& s) { return {a.x * s, a.y * s, a.z * s}; }
};

Wide3 integers_of(Double3 a, int bits)
{
    return {integer_of(a.x, bits), integer_of(a.y, bits), integer_of(a.z, bits)};
}

Wide3 cross_of(const Wide3& a, const Wide3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

WideInteger dot_of(const Wide3& a, const Wide3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// numerator / denominator 2^exponent. Precondition: denominator > 0.
struct Fraction {
    WideInteger numerator, denominator;
    int exponent = 0;

    [[nodiscard]] int compared_with(double value) const
    {
        if (std::isinf(value)) return value > 0 ? -1 : 1;
        const int bits = std::max(-exponent, bits_of(value).value_or(0));
        const WideInteger mine = numerator << static_cast<unsigned>(exponent + bits);
        return mine.compare(WideInteger(integer_of(value, bits) * denominator));
    }
    // With another one of the same exponent.
    [[nodiscard]] int compared_with(const Fraction& other) const
    {
        return WideInteger(numerator * other.denominator).compare(WideInteger(other.numerator * denominator));
    }
    [[nodiscard]] double value() const
    {
        using Quad = boost::multiprecision::cpp_bin_float_quad; // rounded a few times: off by less than 2^-109 of it
        return ldexp(Quad(numerator) / Quad(denominator), exponent).convert_to<double>();
    }
};

} // namespace

// A ray and a triangle as integers, whose corners are seen from the ray's origin.
struct NearestSearch::Exact {
    Exact(const NearestSearch& search, const MeshRay& ray)
        : mesh(search.mesh_), point_bits(bits_of(ray.origin, search.bits_)),
          direction_bits(bits_of(ray.direction, -1100)), origin(integers_of(ray.origin, point_bits)),
          direction(integers_of(ray.direction, direction_bits))
    {
    }

    struct Corners {
        std::array<Wide3, 3> at;
        std::array<WideInteger, 3> sides; // of the edges opposite to each corner
    };
    [[nodiscard]] Corners corners_of(std::uint32_t triangle) const
    {
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners.at[i] = integers_of(to_double(mesh.vertices[mesh.triangles[triangle][i]]), point_bits) - origin;
        for (std::size_t i = 0; i < 3; ++i)
            corners.sides[i] = dot_of(direction, cross_of(corners.at[(i + 1) % 3], corners.at[(i + 2) % 3]));
        return corners;
    }
    // Whether the line meets the closed triangle, in one point.
    [[nodiscard]] static bool is_met(const Corners& corners)
    {
        const int signs[] = {corners.sides[0].sign(), corners.sides[1].sign(), corners.sides[2].sign()};
        const auto [low, high] = std::minmax({signs[0], signs[1], signs[2]});
        return (low >= 0 && high > 0) || (high <= 0 && low < 0);
    }
    [[nodiscard]] static bool is_edge_on(const Corners& corners)
    {
        return corners.sides[0].is_zero() && corners.sides[1].is_zero() && corners.sides[2].is_zero();
    }
    [[nodiscard]] static Wide3 normal_of(const Corners& corners)
    {
        return cross_of(corners.at[1] - corners.at[0], corners.at[2] - corners.at[0]);
    }
    [[nodiscard]] Fraction t_of(const Corners& corners) const
    {
        Fraction t{dot_of(corners.at[0], normal_of(corners)), corners.sides[0] + corners.sides[1] + corners.sides[2],
                   direction_bits - point_bits};
        if (t.denominator.sign() < 0) {
            t.numerator = -t.numerator;
            t.denominator = -t.denominator;
        }
        return t;
    }
    [[nodiscard]] static double weight_of(const Corners& corners, std::size_t corner)
    {
        Fraction weight{corners.sides[corner], corners.sides[0] + corners.sides[1] + corners.sides[2], 0};
        if (weight.denominator.sign() < 0) {
            weight.numerator = -weight.numerator;
            weight.denominator = -weight.denominator;
        }
        return weight.value();
    }

    const TriangleMesh& mesh;
    int point_bits, direction_bits;
    Wide3 origin, direction;
};

class NearestSearch::Search {
public:
    Search(const NearestSearch& search, const MeshRay& ray)
        : search_(search), ray_(ray), end_(ray.t_max), sum_(size_of(ray.direction))
    {
    }

    // Where the ray enters a box, or less by rounding.
    [[nodiscard]] double entry_of(const BoxTree::Node& node) const
    {
        const double from[3] = {ray_.origin.x, ray_.origin.y, ray_.origin.z};
        const double along[3] = {ray_.direction.x, ray_.direction.y, ray_.direction.z};
        double near = ray_.t_min, far = end_;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = node.low[axis], high = node.high[axis];
            if (along[axis] == 0) {
                if (from[axis] < low || from[axis] > high) return unbounded;
                continue;
            }
            const double a = (low - from[axis]) / along[axis], b = (high - from[axis]) / along[axis];
            near = std::max(near, std::min(a, b) - box_share * std::abs(std::min(a, b)));
            far = std::min(far, std::max(a, b) + box_share * std::abs(std::max(a, b)));
        }
        return near <= far ? near : unbounded;
    }
    [[nodiscard]] bool is_needless(double entry) const { return entry > end_; }

    void test(std::uint32_t triangle)
    {
        const auto& [i, j, k] = search_.mesh_.triangles[triangle];
        const auto seen = [&](std::uint32_t v) { return to_double(search_.mesh_.vertices[v]) - ray_.origin; };
        const Double3 a = seen(i), b = seen(j), c = seen(k);
        int sides = 0; // of each sign: which of them are sure
        for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
            const double side = dot(ray_.direction, cross(p, q)),
                         error = rounding_share * sum_ * size_of(p) * size_of(q);
            sides += side > error ? 1 : side < -error ? 16 : 0;
        }
        if ((sides & 15) != 0 && sides >= 16) return;
        const bool is_sure = sides == 3 || sides == 48;
        std::optional<Exact::Corners> corners;
        if (!is_sure) {
            corners = exact().corners_of(triangle);
            if (!Exact::is_met(*corners)) return;
        }
        take({triangle, range_of(a, b, c), std::move(corners), {}});
    }

    [[nodiscard]] std::vector<std::uint32_t> result()
    {
        std::erase_if(met_, [&](const Met& met) { return met.range.low > end_; });
        if (met_.size() > 1) {
            const Met* nearest = &met_.front();
            for (const Met& met : met_)
                if (t_of(met).compared_with(t_of(*nearest)) < 0) nearest = &met;
            const Fraction least = t_of(*nearest);
            std::erase_if(met_, [&](const Met& met) { return t_of(met).compared_with(least) != 0; });
        }
        std::vector<std::uint32_t> triangles;
        for (const Met& met : met_)
            triangles.push_back(met.triangle);
        std::ranges::sort(triangles);
        return triangles;
    }

private:
    struct Range {
        double low, high;
    };
    struct Met {
        std::uint32_t triangle;
        Range range; // of t
        mutable std::optional<Exact::Corners> corners;
        mutable std::optional<Fraction> t;
    };

    [[nodiscard]] const Exact& exact() const
    {
        if (!exact_) exact_.emplace(search_, ray_);
        return *exact_;
    }
    [[nodiscard]] const Fraction& t_of(const Met& met) const
    {
        if (!met.corners) met.corners = exact().corners_of(met.triangle);
        if (!met.t) met.t = exact().t_of(*met.corners);
        return *met.t;
    }

    // Bounds of t at a triangle's plane.
    [[nodiscard]] Range range_of(Double3 a, Double3 b, Double3 c) const
    {
        const Double3 e1 = b - a, e2 = c - a, normal = cross(e1, e2);
        const double determinant = dot(ray_.direction, normal), t = dot(a, normal) / determinant;
        // The edges are differences of corners that were rounded at the origin's size.
        const double sizes = (size_of(a) + size_of(b)) * (size_of(a) + size_of(c));
        const double lost = rounding_share * sizes * sum_;
        if (!(std::abs(determinant) > 2 * lost)) return {-unbounded, unbounded};
        const double error = 2 * (rounding_share * sizes * size_of(a) + std::abs(t) * lost) / std::abs(determinant);
        return {t - error, t + error};
    }

    void take(Met met)
    {
        if (met.range.low > end_ || met.range.high < ray_.t_min) return;
        const bool is_inside = met.range.low >= ray_.t_min && met.range.high <= ray_.t_max;
        if (!is_inside && (t_of(met).compared_with(ray_.t_min) < 0 || t_of(met).compared_with(ray_.t_max) > 0)) return;
        end_ = std::min(end_, met.range.high);
        met_.push_back(std::move(met));
    }

    const NearestSearch& search_;
    const MeshRay& ray_;
    double end_; // no triangle past it is wanted
    double sum_;
    mutable std::optional<Exact> exact_;
    std::vector<Met> met_;
};

NearestSearch::NearestSearch(const TriangleMesh& mesh) : mesh_(mesh), tree_(mesh), bits_(-1100)
{
    for (const Float3 vertex : mesh.vertices)
        bits_ = bits_of(to_double(vertex), bits_);
}

std::vector<std::uint32_t> NearestSearch::nearest(const MeshRay& ray) const
{
    Search search(*this, ray);
    tree_.visit([&](const BoxTree::Node& node) { return search.entry_of(node); },
                [&](double entry) { return search.is_needless(entry); },
                [&](std::uint32_t triangle) { search.test(triangle); });
    return search.result();
}

PlanePoint NearestSearch::point_of(const MeshRay& ray, std::uint32_t triangle) const
{
    const Exact exact(*this, ray);
    const auto corners = exact.corners_of(triangle);
    return {exact.t_of(corners).value(), Exact::weight_of(corners, 1), Exact::weight_of(corners, 2)};
}

bool NearestSearch::sees_edge_on(const MeshRay& ray, std::uint32_t triangle) const
{
    const auto corners = Exact(*this, ray).corners_of(triangle);
    return (corners.sides[0] + corners.sides[1] + corners.sides[2]).is_zero();
}

bool NearestSearch::holds_point_of(const MeshRay& ray, std::uint32_t edge_on, std::uint32_t met) const
{
    const Exact exact(*this, ray);
    const auto corners = exact.corners_of(edge_on);
    const Wide3 normal = Exact::normal_of(corners);
    const bool has_area = !normal.x.is_zero() || !normal.y.is_zero() || !normal.z.is_zero();
    if (!has_area || !Exact::is_edge_on(corners)) return false;
    // All seen from the origin, and times the denominator of t.
    const Fraction t = exact.t_of(exact.corners_of(met));
    const Wide3 point = exact.direction * t.numerator;
    for (std::size_t i = 0; i < 3; ++i) {
        const Wide3 edge = corners.at[(i + 1) % 3] - corners.at[i];
        if (dot_of(cross_of(edge, point - corners.at[i] * t.denominator), normal).sign() < 0) return false;
    }
    return true;
}

} // namespace tetrace
