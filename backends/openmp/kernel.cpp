// One kernel, compiled once per kernel and math mode (CMakeLists.txt), which are given by macros:
// KERNEL_STRUCTURE_HEADER and the like, and KERNEL_NAME. BVH kernels are compiled once more with COUNTS_VISITS, to
// count, and kernels of tasks that cross tets with NOTES_CROSSINGS, to note each tet; these are never timed.
#include "backends/openmp/kernels.h"
#include "core/device/host.h"
#include "core/device/launch.h"

#include <atomic>
#include <bit>
#include <cassert>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#if defined(__SSE2__) && !defined(COUNTS_VISITS)
#include <immintrin.h>
#define HOST_SSE2 // BVHs and walks by records have a form for such processors
#endif

namespace {
#ifdef COUNTS_VISITS
thread_local std::uint32_t nodes_visited, triangles_visited;
#define COUNT_NODE() (nodes_visited++)
#define COUNT_TRIANGLE() (triangles_visited++)
#endif
#ifdef NOTES_CROSSINGS
thread_local tetrace::openmp::Crossings* crossings;
#define NOTE_BEGIN(place) (crossings->tets.clear(), crossings->places.assign(1, place))
#define NOTE_CROSSING(tet, place) (crossings->tets.push_back(tet), crossings->places.push_back(place))
#endif
#define LENGTH_SUMS uint*
#define NO_SUMS nullptr
#define HAS_SUMS(sums) ((sums) != nullptr)
#define ADD_TO_SUM(sums, word, added) std::atomic_ref((sums)[word]).fetch_add(added, std::memory_order_relaxed)
#include "kernels/kernel_cpp.h"

static_assert(sizeof(Hit) == sizeof(tetrace::Hit) && sizeof(LaunchParams) == sizeof(tetrace::LaunchParams));

// What trace_one() returns, as the host's Hit; where visits are counted, the counts replace tet and steps.
template <class Trace>
tetrace::Hit answer(const Trace& trace_one)
{
#ifdef COUNTS_VISITS
    nodes_visited = triangles_visited = 0;
    auto hit = std::bit_cast<tetrace::Hit>(trace_one());
    hit.tet = nodes_visited;
    hit.steps = triangles_visited;
    return hit;
#else
    return std::bit_cast<tetrace::Hit>(trace_one());
#endif
}

// Calls work with the scene, the launch and each pixel of the tiles that this thread takes of an image.
template <class Work>
void for_pixels(const tetrace::PackedScene& packed, const tetrace::TraceJob& job, tetrace::SharedTiles& shared,
                unsigned tile_height, const Work& work)
{
    const SceneView scene = view_of(packed);
    const tetrace::LaunchParams image = launch_params(job, tetrace::domain_of(packed), tile_height, 0);
    const auto launch = std::bit_cast<LaunchParams>(image);
    const uint tiles = tetrace::tile_count(image);
    std::fenv_t environment;
    std::fegetenv(&environment);
    std::fesetenv(FE_DFL_ENV);                                // other libraries leave their threads flushing denormals
    shared.take(tiles, 4, [&work, scene, launch](uint tile) { // by value: bvh4 gains 2 %
        for (uint item = 0; item < TILE_WIDTH * launch.tile_height; ++item)
            if (const Pixel pixel = pixel_of(launch, tile, item); is_in_image(launch, pixel))
                work(scene, launch, pixel);
    });
    std::fesetenv(&environment);
}

#if defined(CROSSES_TETS) && !defined(NOTES_CROSSINGS)
template <bool absorbs>
void cross_all(const tetrace::PackedScene& packed, std::span<const tetrace::Quad> rays, const tetrace::TraceJob& job,
               std::span<std::uint32_t> output, LENGTH_SUMS sums, tetrace::SharedTiles& shared, unsigned tile_height)
{
    tetrace::Hit* const answers = tetrace::as_hits(output).data();
    for_pixels(packed, job, shared, tile_height,
               [&](const SceneView& scene, const ::LaunchParams& launch, Pixel pixel) {
                   const uint ray = ray_index(pixel);
                   answers[ray] = std::bit_cast<tetrace::Hit>(
                       cross_tets(scene, launch.trace, sums, absorbs, rays[ray], rays[ray_count(launch) + ray]));
               });
}
#endif

} // namespace

#define JOINED(prefix, name) prefix##name
#define FUNCTION(prefix, name) JOINED(prefix, name)

namespace tetrace::openmp {

#ifdef NOTES_CROSSINGS
void FUNCTION(note_, KERNEL_NAME)(const PackedScene& packed, bool absorbs, const Quad& direction, const Quad& origin,
                                  std::uint32_t max_steps, Crossings& noted)
{
    TraceParams params{};
    params.max_steps = max_steps;
    crossings = &noted;
    noted = {};
    static_cast<void>(cross_tets(view_of(packed), params, NO_SUMS, absorbs, direction, origin));
}
#else
void FUNCTION(trace_, KERNEL_NAME)(const PackedScene& packed, std::span<const Quad>, const TraceJob& job,
                                   std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height)
{
    tetrace::Hit* const hits = as_hits(output).data();
    for_pixels(packed, job, shared, tile_height,
               [&](const SceneView& scene, const ::LaunchParams& launch, Pixel pixel) {
                   hits[std::size_t{pixel.y} * launch.trace.width + pixel.x] =
                       answer([&] { return trace(scene, launch.trace, primary_ray(launch.trace, pixel.x, pixel.y)); });
               });
}

#ifdef TAKES_RAYS
void FUNCTION(rays_, KERNEL_NAME)(const PackedScene& packed, std::span<const Quad> rays, const TraceJob& job,
                                  std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height)
{
    tetrace::Hit* const hits = as_hits(output).data();
    for_pixels(
        packed, job, shared, tile_height, [&](const SceneView& scene, const ::LaunchParams& launch, Pixel pixel) {
            const uint ray = ray_index(pixel);
            hits[ray] =
                answer([&] { return trace_given(scene, launch.trace, rays[ray], rays[ray_count(launch) + ray]); });
        });
}
#endif

#ifdef SEARCHES_EXITS
void FUNCTION(search_, KERNEL_NAME)(const PackedScene& packed, std::span<const Quad> rays, const TraceJob& job,
                                    std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height)
{
    for_pixels(packed, job, shared, tile_height,
               [&](const SceneView& scene, const ::LaunchParams& launch, Pixel pixel) {
                   const uint ray = ray_index(pixel);
                   const std::size_t count = ray_count(launch);
                   output[ray] = search_exit(scene, rays[ray], rays[count + ray], rays[2 * count + ray]);
               });
}
#endif

#ifdef CROSSES_TETS
void FUNCTION(segments_, KERNEL_NAME)(const PackedScene& packed, std::span<const Quad> rays, const TraceJob& job,
                                      std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height)
{
    cross_all<false>(packed, rays, job, output, NO_SUMS, shared, tile_height);
}

void FUNCTION(tally_, KERNEL_NAME)(const PackedScene& packed, std::span<const Quad> rays, const TraceJob& job,
                                   std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height)
{
    cross_all<false>(packed, rays, job, output, output.data() + HIT_WORDS * job.rays(), shared, tile_height);
}

void FUNCTION(absorb_, KERNEL_NAME)(const PackedScene& packed, std::span<const Quad> rays, const TraceJob& job,
                                    std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height)
{
    cross_all<true>(packed, rays, job, output, NO_SUMS, shared, tile_height);
}
#endif
#endif

} // namespace tetrace::openmp
