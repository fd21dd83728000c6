#include "backends/embree/session.h"

#include "backends/embree/given_rays.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tetrace::embree {
namespace {
#include "kernels/rays_cpp.h"

#include "kernels/language/params_cpp.h"

constexpr std::uint32_t packet_size = 4; // 4 x 4 pixels
constexpr std::uint32_t tile_size = 8;

tetrace::Hit hit_of(unsigned primitive, float t, float u, float v)
{
    if (primitive == RTC_INVALID_GEOMETRY_ID) return {NO_HIT, NO_TET, 0, 0, 0, 0};
    return {primitive, NO_TET, t, u, v, 0};
}

tetrace::Hit trace_one(const Accelerator& accelerator, const TraceParams& params, std::uint32_t x, std::uint32_t y)
{
    const Ray ray = primary_ray(params, x, y);
    RTCRayHit query =
        query_of({ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z}, 0,
                 std::numeric_limits<float>::infinity());
    accelerator.intersect(query, Coherence::coherent);
    return hit_of(query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v);
}

void trace_packet(const Accelerator& accelerator, const TraceParams& params, std::uint32_t x0, std::uint32_t y0,
                  tetrace::Hit* hits)
{
    alignas(64) int valid[16];
    RTCRayHit16 query;
    for (std::uint32_t i = 0; i < 16; ++i) {
        const std::uint32_t x = x0 + i % packet_size;
        const std::uint32_t y = y0 + i / packet_size;
        valid[i] = x < params.width && y < params.height ? -1 : 0;
        const Ray ray = primary_ray(params, x, y);
        query.ray.org_x[i] = ray.origin.x;
        query.ray.org_y[i] = ray.origin.y;
        query.ray.org_z[i] = ray.origin.z;
        query.ray.dir_x[i] = ray.direction.x;
        query.ray.dir_y[i] = ray.direction.y;
        query.ray.dir_z[i] = ray.direction.z;
        query.ray.tnear[i] = 0;
        query.ray.tfar[i] = std::numeric_limits<float>::infinity();
        query.ray.time[i] = 0;
        query.ray.mask[i] = ~0u;
        query.ray.id[i] = 0;
        query.ray.flags[i] = 0;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    accelerator.intersect16(valid, query, Coherence::coherent);
    for (std::uint32_t i = 0; i < 16; ++i) {
        if (valid[i] == 0) continue;
        const std::size_t pixel = std::size_t{y0 + i / packet_size} * params.width + x0 + i % packet_size;
        hits[pixel] = hit_of(query.hit.primID[i], query.ray.tfar[i], query.hit.u[i], query.hit.v[i]);
    }
}

void trace_tile(const Accelerator& accelerator, Method method, const TraceParams& params, std::uint32_t x0,
                std::uint32_t y0, tetrace::Hit* hits)
{
    const std::uint32_t x1 = std::min(x0 + tile_size, params.width);
    const std::uint32_t y1 = std::min(y0 + tile_size, params.height);
    const std::uint32_t step = method == Method::packet16 ? packet_size : 1;
    for (std::uint32_t y = y0; y < y1; y += step) {
        for (std::uint32_t x = x0; x < x1; x += step) {
            if (method == Method::packet16)
                trace_packet(accelerator, params, x, y, hits);
            else
                hits[std::size_t{y} * params.width + x] = trace_one(accelerator, params, x, y);
        }
    }
}

} // namespace

void trace_image(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<tetrace::Hit> hits,
                 unsigned threads)
{
    const TraceParams params = params_of(job);
    const std::uint32_t tiles_x = (job.width + tile_size - 1) / tile_size;
    const std::uint32_t tiles = tiles_x * ((job.height + tile_size - 1) / tile_size);
#pragma omp parallel for schedule(dynamic, 4) num_threads(static_cast <int>(threads))
    for (std::uint32_t tile = 0; tile < tiles; ++tile)
        trace_tile(accelerator, method, params, tile % tiles_x * tile_size, tile / tiles_x * tile_size, hits.data());
}

EmbreeSession::EmbreeSession(Method method, Task task, std::shared_ptr<const Accelerator> accelerator, unsigned threads)
    : HostSession(task), method_(method), task_(task), accelerator_(std::move(accelerator)), threads_(threads)
{
}

void EmbreeSession::run(const TraceJob& job, std::span<std::uint32_t> output)
{
    if (task_ == Task::rays)
        trace_given(*accelerator_, method_, job, rays_, as_hits(output), threads_);
    else
        trace_image(*accelerator_, method_, job, as_hits(output), threads_);
}

} // namespace tetrace::embree
