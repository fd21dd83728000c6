#include "core/rays/ray_offset.h"

#include "core/base/exact.h"

#include <bit>
#include <cmath>

namespace tetrace {
namespace {

float offset_coordinate(float coordinate, float normal)
{
    constexpr float near_zero = 1.0F / 32, scale = 1.0F / 65536, units = 256;
    if (std::abs(coordinate) < near_zero) return coordinate + scale * normal;
    const auto steps = static_cast<std::int32_t>(units * normal);
    const std::int32_t bits = std::bit_cast<std::int32_t>(coordinate) + (coordinate < 0 ? -steps : steps);
    return std::bit_cast<float>(bits);
}

} // namespace

Float3 offset_point(Float3 point, Float3 normal)
{
    return snap_to_grid(Float3{offset_coordinate(point.x, normal.x), offset_coordinate(point.y, normal.y),
                               offset_coordinate(point.z, normal.z)});
}

Float3 offset_origin(const GivenRay& ray, const TriangleMesh& mesh)
{
    if (ray.triangle == FREE_FACE) return ray.origin;
    const auto& [a, b, c] = mesh.triangles.at(ray.triangle);
    const Double3 v0 = to_double(mesh.vertices[a]);
    const Double3 normal = normalized(cross(to_double(mesh.vertices[b]) - v0, to_double(mesh.vertices[c]) - v0));
    const double side = dot(normal, to_double(ray.direction)) < 0 ? -1 : 1;
    return offset_point(ray.origin, to_float(normal * side));
}

} // namespace tetrace
