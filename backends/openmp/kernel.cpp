// One kernel: compiled once per method, layout and math mode (CMakeLists.txt), which arrive as
// KERNEL_METHOD_HEADER, KERNEL_LAYOUT_HEADER and KERNEL_SYMBOL.
#include "backends/openmp/kernels.h"

#include <bit>
#include <cassert>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace {
#include "kernels/kernel_cpp.h"

constexpr uint tile_size = 8; // pixels of a tile share most of their way

void trace_tile(const SceneView& scene, const TraceParams& params, uint tile, tetrace::Hit* hits)
{
    const uint tiles_x = (params.width + tile_size - 1) / tile_size;
    const uint x0 = tile % tiles_x * tile_size;
    const uint y0 = tile / tiles_x * tile_size;
    for (uint y = y0; y < y0 + tile_size && y < params.height; y++) {
        for (uint x = x0; x < x0 + tile_size && x < params.width; x++) {
            static_assert(sizeof(Hit) == sizeof(tetrace::Hit));
            const Hit hit = trace(scene, params, primary_ray(params, x, y));
            hits[std::size_t{y} * params.width + x] = std::bit_cast<tetrace::Hit>(hit);
        }
    }
}

} // namespace

namespace tetrace::openmp {

void KERNEL_SYMBOL(const PackedScene& packed, const TraceJob& job, Hit* hits, unsigned threads)
{
    const SceneView scene = view_of(packed);
    const TraceParams params = params_of(job);
    const uint tiles = ((job.width + tile_size - 1) / tile_size) * ((job.height + tile_size - 1) / tile_size);
#pragma omp parallel num_threads(static_cast <int>(threads))
    {
        std::fenv_t environment;
        std::fegetenv(&environment);
        std::fesetenv(FE_DFL_ENV); // other libraries leave their threads flushing denormals
#pragma omp for schedule(dynamic, 4)
        for (uint tile = 0; tile < tiles; tile++)
            trace_tile(scene, params, tile, hits);
        std::fesetenv(&environment);
    }
}

} // namespace tetrace::openmp
