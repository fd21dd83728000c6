#include "backends/embree/session.h"

#include "backends/embree/accelerator.h"
#include "backends/embree/queries.h"
#include "core/device/backend.h"
#include "core/rays/hit.h"
#include "core/rays/ray_set.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace tetrace::embree {

namespace {

/// The hit of a query for the nearest triangle.
[[nodiscard]] inline Hit nearest_hit(unsigned primitive, float t, float u, float v)
{
    if (primitive == RTC_INVALID_GEOMETRY_ID) return {NO_HIT, NO_TET, 0, 0, 0, 0};
    return {primitive, NO_TET, t, u, v, 0};
}

/// The hit of an occlusion query, which sets the end of an occluded ray to -inf.
[[nodiscard]] inline Hit any_hit(float end)
{
    return {end < 0 ? SOME_HIT : NO_HIT, NO_TET, 0, 0, 0, 0};
}

template <unsigned width>
struct PacketOf;

template <>
struct PacketOf<8> {
    using Type = RTCRayHit8;
};

template <>
struct PacketOf<16> {
    using Type = RTCRayHit16;
};

/// Packets of `width` rays for one call of Embree: one packet, or a stream of them.
template <unsigned width, unsigned packets>
class Batch {
public:
    void set(unsigned packet, unsigned lane, Float3 origin, Float3 direction, float end)
    {
        auto& [in, out] = packets_[packet];
        in.org_x[lane] = origin.x;
        in.org_y[lane] = origin.y;
        in.org_z[lane] = origin.z;
        in.dir_x[lane] = direction.x;
        in.dir_y[lane] = direction.y;
        in.dir_z[lane] = direction.z;
        in.tnear[lane] = 0;
        in.tfar[lane] = end;
        in.time[lane] = 0;
        in.mask[lane] = ~0u;
        in.id[lane] = 0;
        in.flags[lane] = 0;
        out.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        out.primID[lane] = RTC_INVALID_GEOMETRY_ID;
        out.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        if constexpr (packets == 1) valid_[lane] = -1;
    }

    /// Leaves a ray out.
    void clear(unsigned packet, unsigned lane)
    {
        set(packet, lane, {}, {1, 0, 0}, -1);
        if constexpr (packets == 1) valid_[lane] = 0;
    }

    void trace(RTCScene scene, bool any_hit, Coherence coherence)
    {
        if constexpr (packets == 1)
            any_hit ? occlude(scene, valid_, packets_[0].ray, coherence)
                    : intersect(scene, valid_, packets_[0], coherence);
        else
            any_hit ? occlude_stream(scene, std::span(packets_), coherence)
                    : intersect_stream(scene, std::span(packets_), coherence);
    }

    [[nodiscard]] Hit hit(unsigned packet, unsigned lane, bool any_hit) const
    {
        const auto& [in, out] = packets_[packet];
        return any_hit ? embree::any_hit(in.tfar[lane])
                       : nearest_hit(out.primID[lane], in.tfar[lane], out.u[lane], out.v[lane]);
    }

private:
    alignas(64) typename PacketOf<width>::Type packets_[packets];
    alignas(64) int valid_[width];
};

/// Traces given rays into hits, in order, as many at a time as the method says. For jobs that ask for any hit it uses
/// Embree's occlusion query, which does not say what was hit: SOME_HIT. rays: GIVEN_RAY_QUADS per ray, as for
/// Session::set_rays. hits: one per ray.
void trace_given(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<const Quad> rays,
                 std::span<Hit> hits, SharedTiles& tiles);

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

void trace_given(const Accelerator& accelerator, Method method, const TraceJob& job, std::span<const Quad> quads,
                 std::span<tetrace::Hit> hits, SharedTiles& tiles)
{
    const std::size_t count = hits.size();
    const Rays rays{quads.first(count), quads.subspan(count, count), job.any_hit};
    const Call call = call_of(method);
    tiles.take(static_cast<std::uint32_t>((count + call.rays - 1) / call.rays),
               static_cast<std::uint32_t>(1024 / call.rays),
               [&](std::uint32_t i) { call.trace(accelerator, rays, i * call.rays, hits); });
}

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
                 std::span<tetrace::Hit> hits, SharedTiles& shared)
{
    const TraceParams params = params_of(job);
    const Image image{params, hits.data()};
    TraceTile* const trace = trace_tile(method, native_width);
    const std::uint32_t tiles_x = (job.width + tile_size - 1) / tile_size;
    const std::uint32_t tiles = tiles_x * ((job.height + tile_size - 1) / tile_size);
    shared.take(tiles, 4, [&](std::uint32_t tile) {
        trace(accelerator, image, tile % tiles_x * tile_size, tile / tiles_x * tile_size);
    });
}

EmbreeSession::EmbreeSession(const KernelId& kernel, unsigned native_width,
                             std::shared_ptr<const Accelerator> accelerator, unsigned threads)
    : HostSession(kernel.task, threads), kernel_(kernel), native_width_(native_width),
      accelerator_(std::move(accelerator))
{
}

void EmbreeSession::run(const TraceJob& job, std::span<std::uint32_t> output, SharedTiles& tiles)
{
    if (kernel_.task == Task::rays)
        trace_given(*accelerator_, kernel_.method, job, rays_, as_hits(output), tiles);
    else
        trace_image(*accelerator_, kernel_.method, native_width_, job, as_hits(output), tiles);
}

} // namespace tetrace::embree
