#include "bench/truth/witness.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tetrace {
namespace {

using Integer = boost::multiprecision::int512_t;

constexpr int corner_bits = 80;    // corners, and vertices relative to the origin, are multiples of 2^-80
constexpr int direction_bits = 44; // see core/base/exact.cpp

struct Exact3 {
    Integer x, y, z;

    friend Exact3 operator-(const Exact3& a, const Exact3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

Exact3 cross(const Exact3& a, const Exact3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Integer dot(const Exact3& a, const Exact3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// value 2^bits, which is an integer.
Integer scaled(double value, int bits)
{
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    const Integer digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    const int shift = exponent - 53 + bits;
    return shift >= 0 ? Integer(digits * (Integer(1) << shift)) : Integer(digits / (Integer(1) << -shift));
}

Exact3 scaled(Double3 a, int bits)
{
    return {scaled(a.x, bits), scaled(a.y, bits), scaled(a.z, bits)};
}

int sign_of(const Integer& a)
{
    return a.sign();
}

// Sign of det(b - a, c - a, d - a).
int side_of(Double3 a, Double3 b, Double3 c, Double3 d)
{
    const Double3 u = b - a, v = c - a, w = d - a;
    const auto size = [](Double3 p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); };
    const double estimate = dot(u, cross(v, w));
    // Twelve roundings of products of three factors that are themselves rounded.
    if (std::abs(estimate) > 4e-15 * size(u) * size(v) * size(w)) return estimate > 0 ? 1 : -1;
    const Exact3 first = scaled(a, corner_bits);
    return sign_of(
        dot(scaled(b, corner_bits) - first, cross(scaled(c, corner_bits) - first, scaled(d, corner_bits) - first)));
}

enum class Meeting { none, touched, crossed };

// How a segment meets a triangle: crossed where it passes from one side to the other through the interior.
Meeting meeting_of(Double3 from, Double3 to, const std::array<Double3, 3>& triangle)
{
    const auto& [a, b, c] = triangle;
    const int before = side_of(a, b, c, from), after = side_of(a, b, c, to);
    if (before * after > 0) return Meeting::none;
    if (before == 0 && after == 0) return Meeting::touched; // maybe not, but it is in the plane
    const int sides[] = {side_of(from, to, a, b), side_of(from, to, b, c), side_of(from, to, c, a)};
    const auto [least, most] = std::minmax({sides[0], sides[1], sides[2]});
    if (least < 0 && most > 0) return Meeting::none;
    return before * after < 0 && (least > 0 || most < 0) ? Meeting::crossed : Meeting::touched;
}

// The ray's direction and bound. Double precision decides what it can.
struct ExactTube {
    explicit ExactTube(const WitnessQuestion& question)
        : near_direction(to_double(question.ray.direction)), near_bound(question.bound)
    {
    }
    [[nodiscard]] Exact3 direction() const { return scaled(near_direction, direction_bits); }
    [[nodiscard]] Integer bound() const { return scaled(near_bound, corner_bits); }
    [[nodiscard]] bool contains(Double3 corner) const
    {
        // Rounded, the cross product is off by less than that share of its factors.
        const double reach = near_bound * tetrace::length(near_direction);
        if (tetrace::length(tetrace::cross(corner, near_direction)) <
            0.999 * reach - 4e-15 * tetrace::length(corner) * tetrace::length(near_direction))
            return true;
        const Exact3 along = direction(), across = cross(scaled(corner, corner_bits), along);
        return dot(across, across) <= bound() * bound() * dot(along, along);
    }
    [[nodiscard]] bool ball_contains(Double3 corner) const
    {
        const Exact3 point = scaled(corner, corner_bits);
        return dot(point, point) <= bound() * bound();
    }
    [[nodiscard]] bool goes_back(Double3 from, Double3 to) const
    {
        const double along = tetrace::dot(to - from, near_direction);
        if (along > 4e-15 * tetrace::length(to - from) * tetrace::length(near_direction)) return false;
        return sign_of(dot(scaled(to, corner_bits) - scaled(from, corner_bits), direction())) < 0;
    }

    Double3 near_direction;
    double near_bound;
};

std::array<Double3, 3> corners_from(const TriangleMesh& mesh, Float3 origin, std::uint32_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const auto relative = [&](std::uint32_t v) { return to_double(mesh.vertices[v]) - to_double(origin); };
    return {relative(a), relative(b), relative(c)};
}

bool runs_in_tube(const WitnessQuestion& question, const Witness& witness)
{
    const ExactTube tube(question);
    const auto [x, y, z] = witness.front();
    const bool is_at_origin = x == 0 && y == 0 && z == 0;
    if (!is_at_origin && (question.part.start == NO_HIT || !tube.ball_contains(witness.front()))) return false;
    for (std::size_t i = 0; i < witness.size(); ++i)
        if (!tube.contains(witness[i]) || (i > 0 && tube.goes_back(witness[i - 1], witness[i]))) return false;
    return true;
}

} // namespace

Double3 witness_corner(Double3 point)
{
    const auto rounded = [](double a) { return std::ldexp(std::nearbyint(std::ldexp(a, corner_bits)), -corner_bits); };
    return {rounded(point.x), rounded(point.y), rounded(point.z)};
}

bool is_witness(const TriangleMesh& mesh, const WitnessQuestion& question, const Witness& witness)
{
    if (witness.size() < 2 || !runs_in_tube(question, witness)) return false;
    const Double3 direction = to_double(question.ray.direction);
    const double last = dot(witness.back(), direction);
    // A part's end is a rounded t: 1e-12 of it is nothing.
    const bool is_at_end = question.part.has_end() &&
                           last >= static_cast<double>(question.part.end) * dot(direction, direction) * (1 - 1e-12);
    bool crosses_answer = false;
    for (const std::uint32_t triangle : question.obstacles) {
        const auto corners = corners_from(mesh, question.ray.origin, triangle);
        for (std::size_t i = 1; i < witness.size(); ++i) {
            const Meeting meeting = meeting_of(witness[i - 1], witness[i], corners);
            const bool is_answer = triangle == question.answer && i + 1 == witness.size();
            if (is_answer && meeting == Meeting::crossed) crosses_answer = true;
            if (meeting != Meeting::none && !(is_answer && crosses_answer)) return false;
        }
        const double farthest =
            std::max({dot(corners[0], direction), dot(corners[1], direction), dot(corners[2], direction)});
        if (question.answer == NO_HIT && last <= farthest && !is_at_end) return false;
    }
    return crosses_answer == (question.answer != NO_HIT);
}

} // namespace tetrace
