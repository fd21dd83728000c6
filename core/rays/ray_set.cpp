#include "core/rays/ray_set.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/base/hash.h"
#include "core/base/random_words.h"
#include "core/pack/packed_scene.h"
#include "core/rays/entering.h"
#include "core/rays/ray_start.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>

namespace tetrace {
namespace {
namespace ray_kernel {
#include "kernels/rays_cpp.h"

tetrace::Float3 pixel_direction(const View& view, std::uint32_t x, std::uint32_t y)
{
    const Vec3 direction = primary_ray(params_of(view), x, y).direction;
    return {direction.x, direction.y, direction.z};
}

// As the kernels round every direction, so that no intermediate product is denormal.
tetrace::Float3 clean_direction(Double3 direction)
{
    const auto rounded = tetrace::to_float(direction);
    return {flush_tiny(rounded.x), flush_tiny(rounded.y), flush_tiny(rounded.z)};
}
} // namespace ray_kernel

using ray_kernel::clean_direction;

constexpr std::uint32_t image_tile = 8;       // pixels along a side of the tiles that rays are ordered by
constexpr std::uint32_t max_draws = 64;       // attempts at a direction; a face that accepts none of them makes no ray
constexpr double shortest_to_light = 0x1p-10; // of a shadow ray, in domain units

std::uint32_t stream_of(RayKind kind)
{
    return 1 + static_cast<std::uint32_t>(kind); // 0 belongs to the search set
}

GivenRay primary_given(const RaySource& source, std::uint32_t pixel)
{
    const Float3 direction = ray_kernel::pixel_direction(source.view, pixel % source.width, pixel / source.width);
    const Float3 origin = source.view.origin;
    const std::uint32_t half_face =
        source.start_tet == NO_TET
            ? NO_HALF_FACE
            : make_half_face(source.start_tet, face_behind(source.scene.tets, source.start_tet, origin, direction));
    return {origin, direction, NO_END, half_face, FREE_FACE, pixel};
}

// Chords between two uniform points of a sphere are its isotropic uniform lines; those that meet the box are the box's
// isotropic uniform lines.
struct LineSphere {
    Double3 centre;
    double radius;
};

LineSphere sphere_round(const Domain& domain)
{
    const Double3 low = to_double(domain.low()), high = to_double(domain.high());
    return {(low + high) * 0.5, length(high - low) * (0.5 * 1.0625)}; // no point of it is in the box
}

GivenRay random_given(const RaySource& source, std::uint32_t pixel)
{
    const LineSphere sphere = sphere_round(source.scene.domain);
    for (std::uint32_t draw = 0;; draw += 2) {
        const RandomPlace place{stream_of(RayKind::random), source.view_number, pixel, draw};
        const Double3 from = random_direction(place);
        const Double3 to = random_direction({place.stream, place.view, place.pixel, draw + 1});
        if (length(to - from) < 0x1p-10) continue; // a chord of the sphere that short is far from the box
        const Float3 origin = snap_to_grid(to_float(sphere.centre + from * sphere.radius));
        const Float3 direction = clean_direction(normalized(to - from));
        if (enters(source.scene.domain, to_double(origin), to_double(direction)))
            return {origin, direction, NO_END, NO_HALF_FACE, FREE_FACE, pixel};
    }
}

std::optional<GivenRay> leaving(const RayStart& start, Float3 direction, float end, std::uint32_t triangle,
                                std::uint32_t pixel)
{
    if (!enters(start, direction)) return std::nullopt;
    return GivenRay{start.origin, direction, end, start.half_face, triangle, pixel};
}

// A uniform point of the unit sphere that touches the surface from its outside: cosine-distributed directions.
std::optional<GivenRay> cosine_given(RayKind kind, const RaySource& source, const RayStart& start, float end,
                                     std::uint32_t triangle, std::uint32_t pixel)
{
    for (std::uint32_t draw = 0; draw < max_draws; ++draw) {
        const Double3 sum = start.inward + random_direction({stream_of(kind), source.view_number, pixel, draw});
        if (length(sum) < 0x1p-10) continue; // its direction would be mostly rounding error
        if (const auto ray = leaving(start, clean_direction(normalized(sum)), end, triangle, pixel)) return ray;
    }
    return std::nullopt;
}

std::optional<GivenRay> shadow_given(const RaySource& source, const RayStart& start, std::uint32_t triangle,
                                     std::uint32_t pixel)
{
    const Double3 way = to_double(light_of(source.scene.domain, source.view.origin)) - to_double(start.origin);
    if (length(way) < shortest_to_light) return std::nullopt;
    return leaving(start, clean_direction(way), 1.0F, triangle, pixel);
}

class RayMaker {
public:
    RayMaker(RayKind kind, const RaySource& source)
        : kind_(kind), source_(source),
          end_(kind == RayKind::ao ? static_cast<float>(ao_reach(source.scene.mesh)) : NO_END)
    {
    }

    [[nodiscard]] std::optional<GivenRay> ray_of(std::uint32_t pixel) const
    {
        if (kind_ == RayKind::primary) return primary_given(source_, pixel);
        if (kind_ == RayKind::random) return random_given(source_, pixel);
        const Hit hit = source_.hits[pixel];
        if (hit.face_id >= source_.scene.mesh.triangles.size()) return std::nullopt; // a miss, or lost
        const RayStart start = start_of(hit, pixel);
        if (kind_ == RayKind::shadow) return shadow_given(source_, start, hit.face_id, pixel);
        return cosine_given(kind_, source_, start, end_, hit.face_id, pixel);
    }

private:
    [[nodiscard]] RayStart start_of(Hit hit, std::uint32_t pixel) const
    {
        if (source_.scene.tets.tets.empty())
            return ray_start(source_.scene.mesh, hit,
                             ray_kernel::pixel_direction(source_.view, pixel % source_.width, pixel / source_.width));
        hit.tet = scene_tet(hit);
        return ray_start(source_.scene, hit);
    }
    [[nodiscard]] std::uint32_t scene_tet(const Hit& hit) const
    {
        if (hit.tet >= source_.mesh_of_packed.size())
            throw Error(ErrorKind::internal, "making rays: a hit names tet " + std::to_string(hit.tet) + " of " +
                                                 std::to_string(source_.mesh_of_packed.size()));
        return source_.mesh_of_packed[hit.tet];
    }

    RayKind kind_;
    const RaySource& source_;
    float end_;
};

// Pixels in the order of tiles: tile after tile, row after row in each.
std::vector<std::uint32_t> pixels_by_tile(std::uint32_t width, std::uint32_t height)
{
    std::vector<std::uint32_t> pixels;
    pixels.reserve(std::size_t{width} * height);
    for (std::uint32_t y0 = 0; y0 < height; y0 += image_tile)
        for (std::uint32_t x0 = 0; x0 < width; x0 += image_tile)
            for (std::uint32_t y = y0; y < std::min(y0 + image_tile, height); ++y)
                for (std::uint32_t x = x0; x < std::min(x0 + image_tile, width); ++x)
                    pixels.push_back(y * width + x);
    return pixels;
}

} // namespace

std::vector<std::uint32_t> inverse_of(std::span<const std::uint32_t> packed_of_mesh)
{
    std::vector<std::uint32_t> mesh_of_packed(packed_of_mesh.size());
    for (std::uint32_t tet = 0; tet < packed_of_mesh.size(); ++tet)
        mesh_of_packed.at(packed_of_mesh[tet]) = tet;
    return mesh_of_packed;
}

RaySet make_rays(RayKind kind, const RaySource& source)
{
    const std::size_t pixels = std::size_t{source.width} * source.height;
    const bool from_hits = kind != RayKind::primary && kind != RayKind::random;
    if (from_hits && source.hits.size() != pixels)
        throw Error(ErrorKind::internal, "making rays: " + std::to_string(source.hits.size()) + " hits for " +
                                             std::to_string(pixels) + " pixels");
    RaySet set{kind, RayOrder::tiles, kind == RayKind::shadow || kind == RayKind::ao, source.view_number, source.width,
               {}};
    const RayMaker maker(kind, source);
    for (const std::uint32_t pixel : pixels_by_tile(source.width, source.height))
        if (const auto ray = maker.ray_of(pixel)) set.rays.push_back(*ray);
    while (set.rays.size() % TILE_WIDTH != 0) {
        const GivenRay last = set.rays.back();
        set.rays.push_back(last);
    }
    return set;
}

Float3 light_of(const Domain& domain, Float3 camera)
{
    const Float3 low = domain.low(), high = domain.high();
    const Double3 centre = (to_double(low) + to_double(high)) * 0.5;
    const Double3 away = to_double(camera) - centre;
    const double offset[3] = {away.x, away.y, away.z};
    int least = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(offset[axis]) < std::abs(offset[least])) least = axis;
    Float3 corner;
    for (int axis = 0; axis < 3; ++axis)
        corner[axis] = (offset[axis] < 0) == (axis == least) ? high[axis] : low[axis];
    return snap_to_grid(to_float(to_double(corner) + (centre - to_double(corner)) * 0x1p-7));
}

double ao_reach(const TriangleMesh& mesh)
{
    return 0.25 * bounding_sphere(mesh).radius;
}

std::uint64_t ray_hash(const RaySet& set)
{
    return hash_of(set.rays, set.any_hit ? 1 : 0);
}

} // namespace tetrace
