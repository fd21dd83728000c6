#include "backends/embree/session.h"

#include "backends/embree/batch.h"
#include "backends/embree/given_rays.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tetrace::embree {
namespace {
#include "kernels/rays_cpp.h"

#include "kernels/language/params_cpp.h"

constexpr std::uint32_t tile_size = 8;
constexpr float no_end = std::numeric_limits<float>::infinity();

tetrace::Float3 vector_of(const Vec3& v)
{
    return {v.x, v.y, v.z};
}

struct Image {
    const TraceParams& params;
    tetrace::Hit* hits;

    [[nodiscard]] tetrace::Hit& at(std::uint32_t x, std::uint32_t y) const
    {
        return hits[std::size_t{y} * params.width + x];
    }
};

void trace_singly(const Accelerator& accelerator, const Image& image, std::uint32_t x0, std::uint32_t y0)
{
    for (std::uint32_t y = y0; y < std::min(y0 + tile_size, image.params.height); ++y)
        for (std::uint32_t x = x0; x < std::min(x0 + tile_size, image.params.width); ++x) {
            const Ray ray = primary_ray(image.params, x, y);
            RTCRayHit query = query_of(vector_of(ray.origin), vector_of(ray.direction), 0, no_end);
            intersect(accelerator.scene(), query, Coherence::coherent);
            image.at(x, y) = nearest_hit(query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v);
        }
}

/// Pixels of a packet: 2 x 4 or 4 x 4; 4 x 2 has 0.99 of the rate of 2 x 4, 8 x 1 0.86, and 8 x 2 of 16 rays 0.86 to
/// 0.93 of that of 4 x 4 (docs/embree.md).
template <unsigned width>
constexpr std::uint32_t packet_columns = width / 4;

/// Traces a tile of the image as batches of `packets` packets of `width` rays. is_whole: all of it is in the image.
template <unsigned width, unsigned packets, bool is_whole>
void trace_batches(const Accelerator& accelerator, const Image& image, std::uint32_t x0, std::uint32_t y0)
{
    constexpr std::uint32_t columns = packet_columns<width>, across = tile_size / columns;
    const auto has = [&](std::uint32_t x, std::uint32_t y) {
        return is_whole || (x < image.params.width && y < image.params.height);
    };
    Batch<width, packets> batch;
    for (std::uint32_t first = 0; first < tile_size * tile_size / width; first += packets) {
        for (std::uint32_t i = 0; i < packets; ++i) {
            const std::uint32_t x = x0 + (first + i) % across * columns, y = y0 + (first + i) / across * 4;
            for (std::uint32_t lane = 0; lane < width; ++lane) { // no branches: compilers make vectors of it
                const Ray ray = primary_ray(image.params, x + lane % columns, y + lane / columns);
                batch.set(i, lane, vector_of(ray.origin), vector_of(ray.direction), no_end);
            }
            for (std::uint32_t lane = 0; lane < width; ++lane)
                if (!has(x + lane % columns, y + lane / columns)) batch.clear(i, lane);
        }
        batch.trace(accelerator.scene(), false, Coherence::coherent);
        for (std::uint32_t i = 0; i < packets; ++i) {
            const std::uint32_t x = x0 + (first + i) % across * columns, y = y0 + (first + i) / across * 4;
            for (std::uint32_t lane = 0; lane < width; ++lane)
                if (has(x + lane % columns, y + lane / columns))
                    image.at(x + lane % columns, y + lane / columns) = batch.hit(i, lane, false);
        }
    }
}

template <unsigned width, unsigned packets>
void trace_in_batches(const Accelerator& accelerator, const Image& image, std::uint32_t x0, std::uint32_t y0)
{
    const bool is_whole = x0 + tile_size <= image.params.width && y0 + tile_size <= image.params.height;
    (is_whole ? trace_batches<width, packets, true> : trace_batches<width, packets, false>)(accelerator, image, x0, y0);
}

using TraceTile = void(const Accelerator& accelerator, const Image& image, std::uint32_t x0, std::uint32_t y0);

/// A stream is a tile, in packets of the native width: Embree would copy others.
TraceTile* trace_tile(Method method, unsigned native_width)
{
    switch (method) {
    case Method::packet8: return trace_in_batches<8, 1>;
    case Method::packet16: return trace_in_batches<16, 1>;
    case Method::stream: return native_width == 16 ? trace_in_batches<16, 4> : trace_in_batches<8, 8>;
    default: return trace_singly;
    }
}

} // namespace

void trace_image(const Accelerator& accelerator, Method method, unsigned native_width, const TraceJob& job,
                 std::span<tetrace::Hit> hits, unsigned threads)
{
    const TraceParams params = params_of(job);
    const Image image{params, hits.data()};
    TraceTile* const trace = trace_tile(method, native_width);
    const std::uint32_t tiles_x = (job.width + tile_size - 1) / tile_size;
    const std::uint32_t tiles = tiles_x * ((job.height + tile_size - 1) / tile_size);
#pragma omp parallel for schedule(dynamic, 4) num_threads(static_cast <int>(threads))
    for (std::uint32_t tile = 0; tile < tiles; ++tile)
        trace(accelerator, image, tile % tiles_x * tile_size, tile / tiles_x * tile_size);
}

EmbreeSession::EmbreeSession(const KernelId& kernel, unsigned native_width,
                             std::shared_ptr<const Accelerator> accelerator, unsigned threads)
    : HostSession(kernel.task), kernel_(kernel), native_width_(native_width), accelerator_(std::move(accelerator)),
      threads_(threads)
{
}

void EmbreeSession::run(const TraceJob& job, std::span<std::uint32_t> output)
{
    if (kernel_.task == Task::rays)
        trace_given(*accelerator_, kernel_.method, job, rays_, as_hits(output), threads_);
    else
        trace_image(*accelerator_, kernel_.method, native_width_, job, as_hits(output), threads_);
}

} // namespace tetrace::embree
