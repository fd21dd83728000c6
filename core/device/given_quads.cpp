#include "core/device/given_quads.h"

#include "core/base/error.h"
#include "core/rays/ray_start.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace tetrace {
namespace {

Quad given_quad(Float3 a, std::uint32_t last)
{
    return {std::bit_cast<std::uint32_t>(a.x), std::bit_cast<std::uint32_t>(a.y), std::bit_cast<std::uint32_t>(a.z),
            last};
}

std::uint32_t packed_half_face(std::uint32_t half_face, const PackedScene& packed)
{
    if (half_face == NO_HALF_FACE) return NO_HALF_FACE;
    if (half_face_tet(half_face) >= packed.packed_of_mesh.size())
        throw Error(ErrorKind::internal, "packing rays: one starts in tet " + std::to_string(half_face_tet(half_face)) +
                                             " of " + std::to_string(packed.packed_of_mesh.size()));
    return make_half_face(packed.packed_of_mesh[half_face_tet(half_face)], half_face_index(half_face));
}

// half_face_of and origin_of: the half-face and the origin that the quads hold for a ray.
template <class HalfFaceOf, class OriginOf>
std::vector<Quad> quads_of_rays(const RaySet& set, const HalfFaceOf& half_face_of, const OriginOf& origin_of)
{
    const std::size_t count = set.rays.size();
    std::vector<Quad> quads(GIVEN_RAY_QUADS * count);
    for (std::size_t i = 0; i < count; ++i) {
        const GivenRay& ray = set.rays[i];
        quads[i] = given_quad(ray.direction, half_face_of(ray));
        quads[count + i] = given_quad(origin_of(ray), std::bit_cast<std::uint32_t>(ray.end));
    }
    return quads;
}

} // namespace

std::vector<Quad> given_quads(const RaySet& set, const PackedScene& packed)
{
    return quads_of_rays(
        set, [&](const GivenRay& ray) { return packed_half_face(ray.half_face, packed); },
        [](const GivenRay& ray) { return ray.origin; });
}

std::uint32_t stretch_of(Float3 direction)
{
    const Double3 d = to_double(direction);
    const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    return static_cast<std::uint32_t>(std::sqrt(dot(d, d)) / largest * 0x1p31 + 0.5);
}

std::vector<Quad> segment_quads(const RaySet& set, const PackedScene& packed)
{
    std::vector<Quad> quads = given_quads(set, packed);
    for (std::size_t i = 0; i < set.rays.size(); ++i)
        quads[set.rays.size() + i].w = stretch_of(set.rays[i].direction);
    return quads;
}

std::vector<Quad> given_quads_offset(const RaySet& set, const TriangleMesh& mesh)
{
    return quads_of_rays(
        set, [](const GivenRay&) { return NO_HALF_FACE; },
        [&](const GivenRay& ray) { return offset_origin(ray, mesh); });
}

} // namespace tetrace
