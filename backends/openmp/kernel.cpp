// One kernel: compiled once per method, layout and math mode (CMakeLists.txt), which arrive as
// KERNEL_METHOD_HEADER, KERNEL_LAYOUT_HEADER and KERNEL_SYMBOL.
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

} // namespace

namespace tetrace::openmp {

void KERNEL_SYMBOL(const PackedScene& packed, const TraceJob& job, Hit* hits, unsigned threads, unsigned tile_height)
{
    const SceneView scene = view_of(packed);
    const LaunchParams params = launch_params(job, packed.divisions, tile_height, 0);
    const auto launch = std::bit_cast<::LaunchParams>(params);
    const uint tiles = tile_count(params);
#pragma omp parallel num_threads(static_cast <int>(threads))
    {
        std::fenv_t environment;
        std::fegetenv(&environment);
        std::fesetenv(FE_DFL_ENV); // other libraries leave their threads flushing denormals
#pragma omp for schedule(dynamic, 4)
        for (uint tile = 0; tile < tiles; tile++)
            trace_tile(scene, launch, tile, hits);
        std::fesetenv(&environment);
    }
}

} // namespace tetrace::openmp
