#include "backends/embree/given_rays.h"

#include "core/rays/ray_set.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace tetrace::embree {

namespace {

constexpr std::size_t packet_rays = 16;

tetrace::Hit nearest_hit(unsigned primitive, float t, float u, float v)
{
    if (primitive == RTC_INVALID_GEOMETRY_ID) return {NO_HIT, NO_TET, 0, 0, 0, 0};
    return {primitive, NO_TET, t, u, v, 0};
}

/// Embree sets the end of a ray that is occluded to -inf.
tetrace::Hit any_hit(float end)
{
    return {end < 0 ? SOME_HIT : NO_HIT, NO_TET, 0, 0, 0, 0};
}

Float3 vector_of(const Quad& quad)
{
    return {std::bit_cast<float>(quad.x), std::bit_cast<float>(quad.y), std::bit_cast<float>(quad.z)};
}

/// Quads as two lists (kernels/layouts/layout.h), and what each ray asks for.
struct Rays {
    std::span<const Quad> directions, origins;
    bool any_hit;
};

tetrace::Hit trace_single(const Accelerator& accelerator, const Rays& rays, std::size_t number)
{
    const Quad& origin = rays.origins[number];
    RTCRayHit query =
        query_of(vector_of(origin), vector_of(rays.directions[number]), 0, std::bit_cast<float>(origin.w));
    if (rays.any_hit) {
        accelerator.occluded(query.ray, Coherence::incoherent);
        return any_hit(query.ray.tfar);
    }
    accelerator.intersect(query, Coherence::incoherent);
    return nearest_hit(query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v);
}

void trace_sixteen(const Accelerator& accelerator, const Rays& rays, std::size_t first, std::span<tetrace::Hit> hits)
{
    alignas(64) int valid[packet_rays];
    RTCRayHit16 query{};
    for (std::size_t i = 0; i < packet_rays; ++i) {
        valid[i] = first + i < hits.size() ? -1 : 0;
        if (valid[i] == 0) continue;
        const Quad& direction = rays.directions[first + i];
        const Quad& origin = rays.origins[first + i];
        query.ray.org_x[i] = std::bit_cast<float>(origin.x);
        query.ray.org_y[i] = std::bit_cast<float>(origin.y);
        query.ray.org_z[i] = std::bit_cast<float>(origin.z);
        query.ray.dir_x[i] = std::bit_cast<float>(direction.x);
        query.ray.dir_y[i] = std::bit_cast<float>(direction.y);
        query.ray.dir_z[i] = std::bit_cast<float>(direction.z);
        query.ray.tfar[i] = std::bit_cast<float>(origin.w);
        query.ray.mask[i] = ~0u;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (rays.any_hit)
        accelerator.occluded16(valid, query.ray, Coherence::incoherent);
    else
        accelerator.intersect16(valid, query, Coherence::incoherent);
    for (std::size_t i = 0; i < packet_rays && first + i < hits.size(); ++i)
        hits[first + i] = rays.any_hit
                              ? any_hit(query.ray.tfar[i])
                              : nearest_hit(query.hit.primID[i], query.ray.tfar[i], query.hit.u[i], query.hit.v[i]);
}

} // namespace

void trace_given(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<const Quad> quads,
                 std::span<tetrace::Hit> hits, unsigned threads)
{
    const std::size_t count = hits.size();
    const Rays rays{quads.first(count), quads.subspan(count, count), job.any_hit};
    const bool in_packets = method == Method::packet16;
    const std::size_t step = in_packets ? packet_rays : 1;
#pragma omp parallel for schedule(dynamic, 64) num_threads(static_cast <int>(threads))
    for (std::size_t ray = 0; ray < count; ray += step) {
        if (in_packets)
            trace_sixteen(accelerator, rays, ray, hits);
        else
            hits[ray] = trace_single(accelerator, rays, ray);
    }
}

} // namespace tetrace::embree
