#include "bench/truth/hit_point.h"

#include <cmath>

namespace tetrace {
namespace {

struct Edges {
    Double3 v0, e1, e2;
};

Edges edges_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Double3 v0 = to_double(mesh.vertices[a]);
    return {v0, to_double(mesh.vertices[b]) - v0, to_double(mesh.vertices[c]) - v0};
}

} // namespace

double hit_condition(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle)
{
    const auto [v0, e1, e2] = edges_of(mesh, triangle);
    const Double3 direction = to_double(ray.direction);
    return 1 + 2 * (length(e1) * length(e2) * length(direction) / std::abs(dot(e1, cross(direction, e2))));
}

bool names_one_point(const TriangleMesh& mesh, const ExactRay& ray, const Hit& hit, double bound)
{
    const auto [v0, e1, e2] = edges_of(mesh, hit.face_id);
    const double t = static_cast<double>(hit.t);
    const Double3 on_triangle = v0 + e1 * static_cast<double>(hit.u) + e2 * static_cast<double>(hit.v);
    const double apart = length(to_double(ray.origin) + to_double(ray.direction) * t - on_triangle);
    return apart <= bound * hit_condition(mesh, ray, hit.face_id); // false for NaN
}

} // namespace tetrace
