#include "core/base/exact.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tetrace {

namespace {

using boost::multiprecision::int256_t;
using boost::multiprecision::int512_t;

constexpr double points_per_unit = 0x1p40; // 1 / coordinate_grid
constexpr double directions_per_unit =
    0x1p44; // kernels keep no component in (0, 2^-20): floats there are multiples of 2^-43

template <class Integer>
struct Vector {
    Integer x, y, z;
};

Vector<std::int64_t> to_integers(Float3 a, double scale)
{
    return {static_cast<std::int64_t>(a.x * scale), static_cast<std::int64_t>(a.y * scale),
            static_cast<std::int64_t>(a.z * scale)};
}

Vector<int256_t> difference(Float3 a, Float3 b)
{
    const auto p = to_integers(a, points_per_unit);
    const auto q = to_integers(b, points_per_unit);
    return {p.x - q.x, p.y - q.y, p.z - q.z};
}

Vector<int256_t> wide(const Vector<std::int64_t>& a)
{
    return {a.x, a.y, a.z};
}

Vector<int256_t> cross(const Vector<int256_t>& a, const Vector<int256_t>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

int256_t dot(const Vector<int256_t>& a, const Vector<int256_t>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The ray's parameter at a triangle's plane is numerator / denominator in units of 2^4.
struct Fraction {
    int256_t numerator, denominator;
};

Fraction distance_to_plane(Float3 origin, Float3 direction, Float3 v0, Float3 v1, Float3 v2)
{
    const auto normal = cross(difference(v1, v0), difference(v2, v0));
    return {dot(difference(v0, origin), normal), dot(wide(to_integers(direction, directions_per_unit)), normal)};
}

} // namespace

float snap_to_grid(float coordinate)
{
    // All bits of floats of magnitude 2^-16 and more are at least 2^-40.
    if (std::abs(coordinate) >= 0x1p-16f) return coordinate;
    const double rounded = std::nearbyint(coordinate * points_per_unit) * coordinate_grid;
    return static_cast<float>(rounded) + 0.0f; // never -0
}

Float3 snap_to_grid(Float3 point)
{
    return {snap_to_grid(point.x), snap_to_grid(point.y), snap_to_grid(point.z)};
}

int orientation(Float3 a, Float3 b, Float3 c, Float3 d)
{
    // Differences of grid coordinates are exact in double. Filter: Shewchuk 1997, error bound A of ORIENT3D.
    const Double3 u = to_double(b) - to_double(a);
    const Double3 v = to_double(c) - to_double(a);
    const Double3 w = to_double(d) - to_double(a);
    const double estimate = dot(u, cross(v, w));
    const double permanent = std::abs(u.x) * (std::abs(v.y * w.z) + std::abs(v.z * w.y)) +
                             std::abs(u.y) * (std::abs(v.z * w.x) + std::abs(v.x * w.z)) +
                             std::abs(u.z) * (std::abs(v.x * w.y) + std::abs(v.y * w.x));
    const double bound = 7.8e-16 * permanent;
    if (estimate > bound) return 1;
    if (estimate < -bound) return -1;
    return dot(difference(b, a), cross(difference(c, a), difference(d, a))).sign();
}

ExactCrossing cross_exactly(Float3 origin, Float3 direction, Float3 v0, Float3 v1, Float3 v2)
{
    const auto d = wide(to_integers(direction, directions_per_unit));
    const Vector<int256_t> corners[3] = {difference(v0, origin), difference(v1, origin), difference(v2, origin)};
    ExactCrossing crossing;
    for (int i = 0; i < 3; ++i)
        crossing.edge_side[i] = dot(d, cross(corners[i], corners[(i + 1) % 3])).sign();
    const auto [least, most] = std::minmax({crossing.edge_side[0], crossing.edge_side[1], crossing.edge_side[2]});

    const auto distance = distance_to_plane(origin, direction, v0, v1, v2);
    if (distance.denominator.is_zero()) return crossing;
    crossing.t = 16.0 * (distance.numerator.convert_to<double>() / distance.denominator.convert_to<double>());
    const bool line_meets = least >= 0 || most <= 0;
    crossing.met = line_meets && distance.numerator.sign() * distance.denominator.sign() >= 0;
    return crossing;
}

std::strong_ordering compare_distance(Float3 origin, Float3 direction, const Float3 (&a)[3], const Float3 (&b)[3])
{
    const auto fa = distance_to_plane(origin, direction, a[0], a[1], a[2]);
    const auto fb = distance_to_plane(origin, direction, b[0], b[1], b[2]);
    const int512_t left = int512_t(fa.numerator) * fb.denominator;
    const int512_t right = int512_t(fb.numerator) * fa.denominator;
    const int order = left.compare(right) * fa.denominator.sign() * fb.denominator.sign();
    return order <=> 0;
}

double tie_bound(Float3 origin)
{
    return 10 * 0x1p-24 * (length(to_double(origin)) + std::sqrt(3.0));
}

std::uint64_t ulps_between(float a, float b)
{
    if (a == b) return 0;
    if (!std::isfinite(a) || !std::isfinite(b) || std::signbit(a) != std::signbit(b))
        return std::numeric_limits<std::uint64_t>::max();
    const std::int64_t distance = std::int64_t{std::bit_cast<std::int32_t>(a)} - std::bit_cast<std::int32_t>(b);
    return static_cast<std::uint64_t>(std::abs(distance));
}

} // namespace tetrace
