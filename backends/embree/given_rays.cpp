#include "backends/embree/given_rays.h"

#include "backends/embree/batch.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace tetrace::embree {

namespace {

/// Rays of a stream. Occlusion queries sort a stream by octants, so more rays are better: with 64, shadow and ao rays
/// have 0.92 to 0.99 of the rate that they have with 256; diffuse rays 0.98 to 1.02 (Embree 3.13, AVX-512).
constexpr unsigned stream_rays = 256;

/// Given rays share no path, whatever their order (docs/embree.md).
constexpr Coherence coherence_of_given = Coherence::incoherent;

Float3 vector_of(const Quad& quad)
{
    return {std::bit_cast<float>(quad.x), std::bit_cast<float>(quad.y), std::bit_cast<float>(quad.z)};
}

/// Quads as two lists (kernels/layouts/layout.h), and what each ray asks for.
struct Rays {
    std::span<const Quad> directions, origins;
    bool any_hit;
};

void trace_single(const Accelerator& accelerator, const Rays& rays, std::size_t number, std::span<tetrace::Hit> hits)
{
    const Quad& origin = rays.origins[number];
    RTCRayHit query =
        query_of(vector_of(origin), vector_of(rays.directions[number]), 0, std::bit_cast<float>(origin.w));
    if (rays.any_hit) {
        occlude(accelerator.scene(), query.ray, coherence_of_given);
        hits[number] = any_hit(query.ray.tfar);
    } else {
        intersect(accelerator.scene(), query, coherence_of_given);
        hits[number] = nearest_hit(query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v);
    }
}

template <unsigned width, unsigned packets>
void trace_batch(const Accelerator& accelerator, const Rays& rays, std::size_t first, std::span<tetrace::Hit> hits)
{
    Batch<width, packets> batch;
    for (unsigned packet = 0; packet < packets; ++packet)
        for (unsigned lane = 0; lane < width; ++lane) {
            const std::size_t number = first + packet * width + lane;
            if (number >= hits.size()) {
                batch.clear(packet, lane);
                continue;
            }
            const Quad& origin = rays.origins[number];
            batch.set(packet, lane, vector_of(origin), vector_of(rays.directions[number]),
                      std::bit_cast<float>(origin.w));
        }
    batch.trace(accelerator.scene(), rays.any_hit, coherence_of_given);
    for (unsigned packet = 0; packet < packets; ++packet)
        for (unsigned lane = 0; lane < width; ++lane)
            if (const std::size_t number = first + packet * width + lane; number < hits.size())
                hits[number] = batch.hit(packet, lane, rays.any_hit);
}

/// A call of Embree, and how many rays it traces.
struct Call {
    std::size_t rays;
    void (*trace)(const Accelerator&, const Rays&, std::size_t first, std::span<tetrace::Hit> hits);
};

template <unsigned width, unsigned packets>
constexpr Call call_with = {width* packets, trace_batch<width, packets>};

Call call_of(Method method)
{
    switch (method) {
    case Method::packet8: return call_with<8, 1>;
    case Method::packet16: return call_with<16, 1>;
    case Method::stream: return call_with<8, stream_rays / 8>;
    default: return {1, trace_single};
    }
}

} // namespace

void trace_given(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<const Quad> quads,
                 std::span<tetrace::Hit> hits, unsigned threads)
{
    const std::size_t count = hits.size();
    const Rays rays{quads.first(count), quads.subspan(count, count), job.any_hit};
    const Call call = call_of(method);
#pragma omp parallel for schedule(dynamic, 1024 / call.rays) num_threads(static_cast <int>(threads))
    for (std::size_t ray = 0; ray < count; ray += call.rays)
        call.trace(accelerator, rays, ray, hits);
}

} // namespace tetrace::embree
