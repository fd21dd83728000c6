// One kernel: compiled once per method, layout and math mode (CMakeLists.txt), which arrive as
// KERNEL_METHOD_HEADER, KERNEL_LAYOUT_HEADER, TRACE_SYMBOL and SEARCH_SYMBOL.
#include "backends/openmp/kernels.h"
#include "core/launch.h"

#include <bit>
#include <cassert>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace {
#include "kernels/kernel_cpp.h"

static_assert(sizeof(Hit) == sizeof(tetrace::Hit) && sizeof(LaunchParams) == sizeof(tetrace::LaunchParams));

void trace_tile(const SceneView& scene, const LaunchParams& launch, uint tile, tetrace::Hit* hits)
{
    for (uint item = 0; item < TILE_WIDTH * launch.tile_height; item++) {
        const Pixel pixel = pixel_of(launch, tile, item);
        if (!is_in_image(launch, pixel)) continue;
        const Hit hit = trace(scene, launch.trace, primary_ray(launch.trace, pixel.x, pixel.y));
        hits[std::size_t{pixel.y} * launch.trace.width + pixel.x] = std::bit_cast<tetrace::Hit>(hit);
    }
}

void search_tile(const SceneView& scene, const tetrace::Row* rays, const LaunchParams& launch, uint tile, uint* faces)
{
    const std::size_t count = ray_count(launch);
    for (uint item = 0; item < TILE_WIDTH * launch.tile_height; item++) {
        const Pixel pixel = pixel_of(launch, tile, item);
        if (!is_in_image(launch, pixel)) continue;
        const uint ray = ray_index(pixel);
        faces[ray] = search_exit(scene, rays[ray], rays[count + ray], rays[2 * count + ray]);
    }
}

// Calls work with each tile of an image, on that many threads.
template <class Work>
void for_tiles(const tetrace::LaunchParams& image, unsigned threads, const Work& work)
{
    const uint tiles = tetrace::tile_count(image);
#pragma omp parallel num_threads(static_cast <int>(threads))
    {
        std::fenv_t environment;
        std::fegetenv(&environment);
        std::fesetenv(FE_DFL_ENV); // other libraries leave their threads flushing denormals
#pragma omp for schedule(dynamic, 4)
        for (uint tile = 0; tile < tiles; tile++)
            work(tile);
        std::fesetenv(&environment);
    }
}

} // namespace

namespace tetrace::openmp {

void TRACE_SYMBOL(const PackedScene& packed, const TraceJob& job, Hit* hits, unsigned threads, unsigned tile_height)
{
    const SceneView scene = view_of(packed);
    const LaunchParams params = launch_params(job, packed.divisions, tile_height, 0);
    const auto launch = std::bit_cast<::LaunchParams>(params);
    for_tiles(params, threads, [&](uint tile) { trace_tile(scene, launch, tile, hits); });
}

void SEARCH_SYMBOL(const PackedScene& packed, const Row* rays, const TraceJob& job, std::uint32_t* faces,
                   unsigned threads, unsigned tile_height)
{
    const SceneView scene = view_of(packed);
    const LaunchParams params = launch_params(job, packed.divisions, tile_height, 0);
    const auto launch = std::bit_cast<::LaunchParams>(params);
    for_tiles(params, threads, [&](uint tile) { search_tile(scene, rays, launch, tile, faces); });
}

} // namespace tetrace::openmp
