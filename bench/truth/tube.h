#pragma once

#include "bench/truth/exact_ray.h"
#include "bench/truth/witness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

/// What is near a ray, as the ray sees it, in double precision.
namespace tetrace::tube {

/// A place across the ray, in its tube's cross-section.
struct Double2 {
    double x = 0, y = 0;

    friend Double2 operator+(Double2 a, Double2 b) { return {a.x + b.x, a.y + b.y}; }
    friend Double2 operator-(Double2 a, Double2 b) { return {a.x - b.x, a.y - b.y}; }
    friend Double2 operator*(Double2 a, double s) { return {a.x * s, a.y * s}; }
};

inline double dot(Double2 a, Double2 b)
{
    return a.x * b.x + a.y * b.y;
}

inline double cross(Double2 a, Double2 b)
{
    return a.x * b.y - a.y * b.x;
}

inline double length(Double2 a)
{
    return std::sqrt(dot(a, a));
}

/// Where the ray is the z axis; z is the distance from its origin.
class Frame {
public:
    explicit Frame(const ExactRay& ray) : origin_(to_double(ray.origin)), along_(normalized(to_double(ray.direction)))
    {
        const bool is_near_x = std::abs(along_.x) > 0.7;
        first_ = normalized(cross(along_, is_near_x ? Double3{0, 1, 0} : Double3{1, 0, 0}));
        second_ = cross(along_, first_);
    }
    [[nodiscard]] Double3 local(Float3 point) const
    {
        const Double3 p = to_double(point) - origin_;
        return {dot(p, first_), dot(p, second_), dot(p, along_)};
    }
    [[nodiscard]] Double3 corner(Double2 place, double depth) const
    {
        return witness_corner(first_ * place.x + second_ * place.y + along_ * depth);
    }

private:
    Double3 origin_, along_, first_, second_;
};

/// A triangle in that frame.
struct Facet {
    std::uint32_t triangle;
    std::array<Double3, 3> corners;
};

inline Double2 across(Double3 a)
{
    return {a.x, a.y};
}

/// Where the line through a place, along the ray, passes through a facet; nothing for one that is seen edge-on.
inline std::optional<double> depth_at(const Facet& facet, Double2 place)
{
    const auto& [a, b, c] = facet.corners;
    const Double2 p = across(a) - place, q = across(b) - place, r = across(c) - place;
    const double u = cross(q, r), v = cross(r, p), w = cross(p, q);
    const bool is_inside = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
    if (!is_inside) return std::nullopt;
    return (u * a.z + v * b.z + w * c.z) / (u + v + w);
}

/// Six times the volume of a tet, with its sign.
inline double side_of(Double3 a, Double3 b, Double3 c, Double3 d)
{
    return dot(b - a, cross(c - a, d - a));
}

/// Whether a segment meets a facet, or touches it.
inline bool is_met(const Facet& facet, Double3 from, Double3 to)
{
    const auto& [a, b, c] = facet.corners;
    if (side_of(a, b, c, from) * side_of(a, b, c, to) > 0) return false;
    const double u = side_of(from, to, a, b), v = side_of(from, to, b, c), w = side_of(from, to, c, a);
    return std::min({u, v, w}) >= 0 || std::max({u, v, w}) <= 0;
}

/// An edge of a facet as the ray sees it: its line, as a point and a unit vector.
struct EdgeLine {
    Double2 point, along;

    [[nodiscard]] double side(Double2 place) const { return cross(along, place - point); }
};

/// Both ends of the part of a segment where what `at` makes of it, a linear map, is within a radius of zero; nothing
/// where there is none.
template <class At>
std::vector<Double3> clipped(Double3 from, Double3 to, double radius, const At& at)
{
    const auto p = at(from), pq = at(to) - p;
    const double square = dot(pq, pq), reach = radius * radius;
    if (square == 0) return dot(p, p) <= reach ? std::vector{from, to} : std::vector<Double3>{};
    const double middle = -dot(p, pq) / square;
    const auto foot = p + pq * middle;
    const double half = (reach - dot(foot, foot)) / square;
    if (half < 0) return {};
    const double first = std::max(0.0, middle - std::sqrt(half)), last = std::min(1.0, middle + std::sqrt(half));
    if (first > last) return {};
    return {from + (to - from) * first, from + (to - from) * last};
}

/// A point of a facet, mostly inside it, between where its edges enter and leave that radius (see clipped); nothing
/// where none of them does.
template <class At>
std::optional<Double3> point_within(const Facet& facet, double radius, const At& at)
{
    const auto& [a, b, c] = facet.corners;
    Double3 sum;
    double count = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (const Double3 end : clipped(facet.corners[i], facet.corners[(i + 1) % 3], radius, at)) {
            sum = sum + end;
            ++count;
        }
    if (count == 0) return std::nullopt;
    const Double3 middle = sum * (1 / count); // maybe on an edge: moved inwards
    const Double3 inwards = (a + b + c) * (1.0 / 3) - middle;
    return middle + inwards * std::min(0.25, radius / (64 * std::max(length(across(inwards)), 1e-300)));
}

/// Minimum and maximum depth, within a radius of the ray, of a facet that covers all within it; for any other facet an
/// infinite range.
inline std::pair<double, double> depths_across(const Facet& facet, double radius)
{
    const auto& [a, b, c] = facet.corners;
    constexpr std::pair<double, double> anywhere{-HUGE_VAL, HUGE_VAL};
    const std::optional<double> depth = depth_at(facet, {});
    if (!depth) return anywhere;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double2 p = across(facet.corners[i]), pq = across(facet.corners[(i + 1) % 3]) - p;
        if (std::abs(cross(p, pq)) < radius * length(pq)) return anywhere;
    }
    const Double3 normal = cross(b - a, c - a);
    const double rise = radius * length(across(normal)) / std::abs(normal.z);
    return {*depth - rise, *depth + rise};
}

} // namespace tetrace::tube
