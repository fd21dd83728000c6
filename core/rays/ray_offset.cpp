#include "core/rays/ray_offset.h"

#include "core/base/error.h"
#include "core/base/exact.h"

#include <bit>
#include <cmath>
#include <string>

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

Quad given_quad(Float3 a, std::uint32_t last)
{
    return {std::bit_cast<std::uint32_t>(a.x), std::bit_cast<std::uint32_t>(a.y), std::bit_cast<std::uint32_t>(a.z),
            last};
}

std::uint32_t packed_link(std::uint32_t link, const PackedScene& packed)
{
    if (link == NO_LINK) return NO_LINK;
    if (link_tet(link) >= packed.packed_of_mesh.size())
        throw Error(ErrorKind::internal, "packing rays: one starts in tet " + std::to_string(link_tet(link)) + " of " +
                                             std::to_string(packed.packed_of_mesh.size()));
    return make_link(packed.packed_of_mesh[link_tet(link)], link_face(link));
}

// link_of and origin_of: what the quads have of a ray.
template <class LinkOf, class OriginOf>
std::vector<Quad> quads_of_rays(const RaySet& set, const LinkOf& link_of, const OriginOf& origin_of)
{
    const std::size_t count = set.rays.size();
    std::vector<Quad> quads(GIVEN_RAY_QUADS * count);
    for (std::size_t i = 0; i < count; i++) {
        const GivenRay& ray = set.rays[i];
        quads[i] = given_quad(ray.direction, link_of(ray));
        quads[count + i] = given_quad(origin_of(ray), std::bit_cast<std::uint32_t>(ray.end));
    }
    return quads;
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

std::vector<Quad> given_quads(const RaySet& set, const PackedScene& packed)
{
    return quads_of_rays(
        set, [&](const GivenRay& ray) { return packed_link(ray.link, packed); },
        [](const GivenRay& ray) { return ray.origin; });
}

std::vector<Quad> given_quads_offset(const RaySet& set, const TriangleMesh& mesh)
{
    return quads_of_rays(
        set, [](const GivenRay&) { return NO_LINK; }, [&](const GivenRay& ray) { return offset_origin(ray, mesh); });
}

} // namespace tetrace
