#include "bench/truth/hit_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetrace {
namespace {

constexpr double float_roundoff = 0x1p-24;
// Of products of n rounded factors the error is below n e (1 + 2^-16).
constexpr double raised = 1 + 0x1p-16;

struct Triangle {
    Double3 a, b, c;
    Double3 e1 = b - a, e2 = c - a;
};

Triangle triangle_of(const TriangleMesh& mesh, std::uint32_t number)
{
    const auto& [i, j, k] = mesh.triangles[number];
    return {to_double(mesh.vertices[i]), to_double(mesh.vertices[j]), to_double(mesh.vertices[k])};
}

Double3 magnitudes(Double3 a)
{
    return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

// What a cross product's components are sums of, without signs.
Double3 cross_magnitude(Double3 a, Double3 b)
{
    const Double3 p = magnitudes(a), q = magnitudes(b);
    return {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};
}

double dot_magnitude(Double3 a, Double3 magnitude)
{
    return dot(magnitudes(a), magnitude);
}

bool is_within(double value, double exact, double error)
{
    return std::abs(value - exact) <= error; // false for NaN
}

// t, u and v of a triangle that may be edge-on: no formula gives them, but they name a point of it.
bool names_point_of_edge_on(const Triangle& triangle, const ExactRay& ray, const Hit& hit)
{
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v), t = static_cast<double>(hit.t);
    const Double3 origin = to_double(ray.origin), direction = to_double(ray.direction);
    const double square = dot(direction, direction);
    double least = std::numeric_limits<double>::infinity(), most = -least, reach = 0;
    for (const Double3 corner : {triangle.a, triangle.b, triangle.c}) {
        const double depth = dot(corner - origin, direction) / square;
        least = std::min(least, depth);
        most = std::max(most, depth);
        reach = std::max(reach, length(corner - origin) / std::sqrt(square));
    }
    constexpr double share = 8 * float_roundoff * raised;
    const double slack = share * reach;
    return u >= -share && v >= -share && u + v <= 1 + share && t >= least - slack && t <= most + slack;
}

bool names_one_point(const Triangle& triangle, const ExactRay& ray, const Hit& hit, double bound)
{
    const Double3 direction = to_double(ray.direction);
    const double determinant = std::abs(dot(triangle.e1, cross(direction, triangle.e2)));
    const double condition = 1 + 2 * (length(triangle.e1) * length(triangle.e2) * length(direction) / determinant);
    const Double3 on_triangle =
        triangle.a + triangle.e1 * static_cast<double>(hit.u) + triangle.e2 * static_cast<double>(hit.v);
    const double apart = length(to_double(ray.origin) + direction * static_cast<double>(hit.t) - on_triangle);
    return apart <= bound * condition;
}

HitPoint point_on(const Triangle& triangle, Double3 origin, Double3 direction, double unit_roundoff)
{
    const auto& [a, b, c, e1, e2] = triangle;
    const double e = unit_roundoff * raised;
    const Double3 offset = origin - a;
    const Double3 p = cross(direction, e2), q = cross(offset, e1);
    const Double3 p_magnitude = cross_magnitude(direction, e2), q_magnitude = cross_magnitude(offset, e1);
    const double determinant = dot(e1, p);
    const double determinant_error = 7 * e * dot_magnitude(e1, p_magnitude);
    const double least = std::abs(determinant) - determinant_error;
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (!(least > 0)) return {infinite, infinite, infinite, infinite, infinite, infinite, true};
    const auto error = [&](double quotient, double numerator_error) {
        const double size = std::abs(quotient);
        const double before_division = (numerator_error + size * determinant_error) / least;
        return before_division + 8 * e * (size + before_division); // devices' divisions are off by up to 2.5 units
    };
    HitPoint point{
        dot(e2, q) / determinant, dot(offset, p) / determinant, dot(direction, q) / determinant, 0, 0, 0, false};
    point.may_be_edge_on = std::abs(determinant) <= 24 * (determinant_error / 7); // 16 are asked for, and 7 may be lost
    point.t_error = error(point.t, 8 * e * dot_magnitude(e2, q_magnitude));
    point.u_error = error(point.u, 7 * e * dot_magnitude(offset, p_magnitude));
    point.v_error = error(point.v, 7 * e * dot_magnitude(direction, q_magnitude));
    return point;
}

} // namespace

HitPoint point_of(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle)
{
    return point_of(mesh, to_double(ray.origin), to_double(ray.direction), triangle, float_roundoff);
}

HitPoint point_of(const TriangleMesh& mesh, Double3 origin, Double3 direction, std::uint32_t triangle,
                  double unit_roundoff)
{
    return point_on(triangle_of(mesh, triangle), origin, direction, unit_roundoff);
}

double end_error_of(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle, double bound)
{
    return point_of(mesh, ray, triangle).t_error + bound / length(to_double(ray.direction));
}

bool names_right_point(const TriangleMesh& mesh, const ExactRay& ray, const Hit& hit, HitFormula formula, double bound)
{
    const Triangle triangle = triangle_of(mesh, hit.face_id);
    if (formula == HitFormula::other) return names_one_point(triangle, ray, hit, bound);
    const HitPoint point = point_of(mesh, ray, hit.face_id);
    if (point.may_be_edge_on && names_point_of_edge_on(triangle, ray, hit)) return true;
    return std::isfinite(point.t) && is_within(static_cast<double>(hit.t), point.t, point.t_error) &&
           is_within(static_cast<double>(hit.u), point.u, point.u_error) &&
           is_within(static_cast<double>(hit.v), point.v, point.v_error);
}

} // namespace tetrace
