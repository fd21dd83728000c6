#include "embed/placed_rays.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/mesh/locate.h"
#include "core/rays/ray_start.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tetrace {

namespace {

constexpr double far_away = 32;      // domain units; kernels take coordinates up to 64
constexpr double near_approach = 16; // where far rays begin, before they are nearest to the centre
constexpr double min_component = 0x1p-20;
constexpr std::uint32_t max_walk = 64; // from the tet of the ray before; past it, a ray is located on its own

bool is_finite(const float (&vector)[3])
{
    return std::isfinite(vector[0]) && std::isfinite(vector[1]) && std::isfinite(vector[2]);
}

/// Empty if the ray is accepted.
std::string fault_of(const tetrace_ray& ray)
{
    if (!is_finite(ray.origin)) return "its origin is not finite";
    if (!is_finite(ray.direction)) return "its direction is not finite";
    if (std::ranges::all_of(ray.direction, [](float component) { return component == 0; })) return "its direction is 0";
    if (!(ray.t_min >= 0) || std::isinf(ray.t_min)) return "its t_min is not a number from 0 up";
    if (std::isnan(ray.t_max)) return "its t_max is not a number";
    return "";
}

Double3 vector_of(const float (&vector)[3])
{
    return {vector[0], vector[1], vector[2]};
}

/// Its components are 0 or between 2^-20 and 2. exponent: what it was divided by is 2 to that.
Double3 scaled_direction(Double3 direction, int& exponent)
{
    exponent = std::ilogb(std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)}));
    Double3 scaled = direction * std::ldexp(1.0, -exponent);
    for (double* component : {&scaled.x, &scaled.y, &scaled.z})
        if (std::abs(*component) < min_component) *component = 0;
    return scaled;
}

/// Where a ray begins that must be near: `start`, or later where it comes near the centre; -1 if it never does.
double near_start(Double3 origin, Double3 direction, double start, Double3 centre)
{
    if (length(origin + direction * start - centre) <= far_away) return start;
    const double nearest = dot(centre - origin, direction) / dot(direction, direction);
    if (nearest <= start || length(origin + direction * nearest - centre) > near_approach) return -1;
    return std::max(start, nearest - near_approach / length(direction));
}

} // namespace

PlacedRays::PlacedRays(const Scene& scene, Structure structure, std::span<const tetrace_ray> rays,
                       std::size_t first_number, unsigned threads)
    : scene_(&scene), rays_(rays), first_number_(first_number), ways_(rays.size())
{
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (const std::string fault = fault_of(rays[i]); !fault.empty())
            throw Error(ErrorKind::usage, "tracing: ray " + std::to_string(first_number + i) + ": " + fault);
    set_.kind = RayKind::random;
    const std::size_t padded = (rays.size() + TILE_WIDTH - 1) / TILE_WIDTH * TILE_WIDTH;
    set_.rays.resize(padded);
    const auto count = static_cast<std::ptrdiff_t>(rays.size());
#pragma omp parallel for num_threads(threads)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const auto ray = static_cast<std::size_t>(i);
        set_.rays[ray] = placed(rays_[ray], ways_[ray]);
    }
    if (structure == Structure::cdt) locate_starts(threads);
    std::fill(set_.rays.begin() + count, set_.rays.end(), set_.rays[rays.size() - 1]);
}

GivenRay PlacedRays::placed(const tetrace_ray& ray, Way& way) const
{
    const BuildInfo& build = scene_->build;
    const Double3 centre = (to_double(scene_->domain.low()) + to_double(scene_->domain.high())) * 0.5;
    int exponent = 0;
    const Double3 direction = scaled_direction(vector_of(ray.direction), exponent);
    const Double3 origin = (vector_of(ray.origin) - build.centre) * std::ldexp(1.0, build.scale_exponent);
    const double to_domain = std::ldexp(1.0, build.scale_exponent + exponent);
    const double begin = near_start(origin, direction, ray.t_min * to_domain, centre);
    const double end = ray.t_max * to_domain - begin;
    way = {begin / to_domain, 1 / to_domain, begin < 0 || end < 0};
    GivenRay given{{}, to_float(direction), NO_END, NO_HALF_FACE, FREE_FACE, 0};
    given.origin = snap_to_grid(to_float(way.is_empty ? centre : origin + direction * begin));
    if (end < NO_END) given.end = std::max(static_cast<float>(end), 0.0F);
    return given;
}

void PlacedRays::locate_starts(unsigned threads)
{
    const TetMesh& tets = scene_->tets;
    const auto count = static_cast<std::ptrdiff_t>(rays_.size());
    std::uint32_t last = NO_TET; // neighbours in the list begin near each other
#pragma omp parallel for num_threads(threads) firstprivate(last)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        GivenRay& ray = set_.rays[static_cast<std::size_t>(i)];
        if (!scene_->domain.contains(ray.origin)) continue;
        WalkEnd end;
        if (last != NO_TET) end = walk_to(tets, last, ray.origin, max_walk);
        const std::uint32_t tet = end.kind == WalkEnd::Kind::too_far ? locate(tets, ray.origin) : end.tet;
        if (tet == NO_TET) continue;
        last = tet;
        ray.half_face = make_half_face(tet, face_behind(tets, tet, ray.origin, ray.direction));
    }
}

tetrace_hit PlacedRays::hit_of(std::size_t ray, const Hit& hit) const
{
    const Way& way = ways_[ray];
    if (way.is_empty || hit.face_id == NO_HIT) return {TETRACE_NO_HIT, 0, 0, 0};
    if (hit.face_id >= scene_->mesh.triangles.size())
        throw Error(ErrorKind::wrong_result, "tracing: the device lost ray " + std::to_string(first_number_ + ray) +
                                                 "; `tetrace check` compares its hits with OpenMP's");
    const double t = way.shift + way.scale * static_cast<double>(hit.t);
    return {source_triangle(*scene_, hit.face_id),
            std::clamp(static_cast<float>(t), rays_[ray].t_min, std::max(rays_[ray].t_min, rays_[ray].t_max)), hit.u,
            hit.v};
}

} // namespace tetrace
