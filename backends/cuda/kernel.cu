// The entry points of one kernel, flattened (cmake/Kernels.cmake) and compiled once per math
// mode, by nvcc, by NVRTC, and as host C++ (backends/cuda_host/kernel.cpp). KERNEL_NAME is method_layout_math: a driver
// finds an entry by its name.
#include "kernels/layouts/layout.h"

#include "kernels/language/dialect_cuda.h"

#include "kernels/language/vector.h"

#include "kernels/language/scene_view_cuda.h"

#define LENGTH_SUMS uint*
#define NO_SUMS nullptr
#define HAS_SUMS(sums) ((sums) != nullptr)
#define ADD_TO_SUM(sums, word, added) atomicAdd((sums) + (word), added)
#include "kernels/kernel.h"

#define JOINED(prefix, name) prefix##name
#define ENTRY(prefix, name) JOINED(prefix, name)

KERNEL_FN void write_hit(Hit hit, uint word, uint* output)
{
    uint2* pairs = reinterpret_cast<uint2*>(output + word);
    pairs[0] = make_uint2(hit.face_id, hit.tet);
    pairs[1] = make_uint2(as_bits(hit.t), as_bits(hit.u));
    pairs[2] = make_uint2(as_bits(hit.v), hit.steps);
}

KERNEL_FN void trace_pixel(SceneView scene, LaunchParams launch, uint tile, uint item, uint* output)
{
    Pixel pixel = pixel_of(launch, tile, item);
    if (!is_in_image(launch, pixel)) return;
    Hit hit = trace(scene, launch.trace, primary_ray(launch.trace, pixel.x, pixel.y));
    write_hit(hit, output_word(launch, pixel), output);
}

#ifdef TAKES_RAYS
KERNEL_FN void trace_given_pixel(SceneView scene, LaunchParams launch, uint tile, uint item, uint* output,
                                 const uint4* __restrict__ rays)
{
    Pixel pixel = pixel_of(launch, tile, item);
    if (!is_in_image(launch, pixel)) return;
    uint ray = ray_index(pixel);
    Hit hit = trace_given(scene, launch.trace, __ldg(rays + ray), __ldg(rays + ray_count(launch) + ray));
    write_hit(hit, output_word(launch, pixel), output);
}
#endif

// One ray per thread, one tile per block.
KERNEL_FN void trace_tiles(SceneView scene, LaunchParams launch, uint* output)
{
    trace_pixel(scene, launch, launch.first_tile + blockIdx.x, threadIdx.x, output);
}

// Schedule persistent: as many blocks of whole warps as the device holds at once. Their warps stay, and fetch rays by
// number, one tile's after another's, from a counter, which is 0 at first, until none of the `tiles` is left.
#ifdef REFILLS_LANES
// The rays of a launch by number: those of an image, or given ones. Which is known when it is compiled: with both kinds
// in one program, either waits for the other's registers.
template <bool ARE_GIVEN>
struct Rays {
    LaunchParams launch;
    uint tiles;
    uint* output;
    const uint4* given; // if ARE_GIVEN

    __device__ uint items() const { return tiles * (TILE_WIDTH * launch.tile_height); }
    __device__ Pixel pixel(uint item) const
    {
        uint tile_items = TILE_WIDTH * launch.tile_height;
        return pixel_of(launch, launch.first_tile + item / tile_items, item % tile_items);
    }
    __device__ bool has(uint item) const { return item < items() && is_in_image(launch, pixel(item)); }
    __device__ uint4 quad(uint item, uint number) const
    {
        return __ldg(given + number * ray_count(launch) + ray_index(pixel(item)));
    }
    __device__ Ray ray(uint item) const
    {
        if (ARE_GIVEN) return given_ray(quad(item, 0u), quad(item, 1u));
        return primary_ray(launch.trace, pixel(item).x, pixel(item).y);
    }
    __device__ real end(uint item) const { return ARE_GIVEN ? as_real(quad(item, 1u).w) : real(NO_END); }
    __device__ void write(uint item, Hit hit) const { write_hit(hit, output_word(launch, pixel(item)), output); }
};

KERNEL_FN void trace_persistent(SceneView scene, LaunchParams launch, uint* output, uint* counter, uint tiles)
{
    trace_refilled(scene, launch.trace, Rays<false>{launch, tiles, output, nullptr}, counter);
}

KERNEL_FN void trace_given_persistent(SceneView scene, LaunchParams launch, uint* output, uint* counter, uint tiles,
                                      const uint4* __restrict__ rays)
{
    trace_refilled(scene, launch.trace, Rays<true>{launch, tiles, output, rays}, counter);
}
#else
// Fetches the next warp-full of rays. Returns the number of the calling thread's ray.
// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, section 3.3, and its
// addendum for Kepler, with Karras, 2012. A tile is one or two warps: either all lanes of a warp get a ray, or none.
KERNEL_FN uint fetch_item(uint* counter)
{
    uint lane = threadIdx.x % warpSize;
    uint first = 0u;
    if (lane == 0u) first = atomicAdd(counter, warpSize);
    return __shfl_sync(0xFFFFFFFFu, first, 0) + lane;
}

KERNEL_FN void trace_persistent(SceneView scene, LaunchParams launch, uint* output, uint* counter, uint tiles)
{
    uint tile_items = TILE_WIDTH * launch.tile_height;
    for (uint item = fetch_item(counter); item < tiles * tile_items; item = fetch_item(counter))
        trace_pixel(scene, launch, launch.first_tile + item / tile_items, item % tile_items, output);
}

#ifdef TAKES_RAYS
KERNEL_FN void trace_given_persistent(SceneView scene, LaunchParams launch, uint* output, uint* counter, uint tiles,
                                      const uint4* __restrict__ rays)
{
    uint tile_items = TILE_WIDTH * launch.tile_height;
    for (uint item = fetch_item(counter); item < tiles * tile_items; item = fetch_item(counter))
        trace_given_pixel(scene, launch, launch.first_tile + item / tile_items, item % tile_items, output, rays);
}
#endif
#endif

// Rays from outside have entries of their own: with both kinds in one, either waits for the other's registers.
KERNEL_FN LaunchParams from_outside(LaunchParams launch)
{
    launch.trace.start_tet = NO_TET;
    return launch;
}

extern "C" __global__ void ENTRY(trace_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output)
{
    trace_tiles(scene, from_outside(launch), output);
}

extern "C" __global__ void ENTRY(trace_persistent_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                                 uint* counter, uint tiles)
{
    trace_persistent(scene, from_outside(launch), output, counter, tiles);
}

#ifdef STARTS_IN_TETS
extern "C" __global__ void ENTRY(inside_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output)
{
    trace_tiles(scene, launch, output);
}

extern "C" __global__ void ENTRY(inside_persistent_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                                  uint* counter, uint tiles)
{
    trace_persistent(scene, launch, output, counter, tiles);
}
#endif

#ifdef TAKES_RAYS
// One given ray per thread, one tile per block.
extern "C" __global__ void ENTRY(rays_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                           const uint4* __restrict__ rays)
{
    trace_given_pixel(scene, launch, launch.first_tile + blockIdx.x, threadIdx.x, output, rays);
}

extern "C" __global__ void ENTRY(rays_persistent_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                                uint* counter, uint tiles,
                                                                const uint4* __restrict__ rays)
{
    trace_given_persistent(scene, launch, output, counter, tiles, rays);
}
#endif

#ifdef CROSSES_TETS
// The segments of one given ray per thread, one tile per block. sums, absorbs: as cross_tets() has them.
KERNEL_FN void cross_from_pixel(SceneView scene, LaunchParams launch, LENGTH_SUMS sums, bool absorbs, uint* output,
                                const uint4* __restrict__ rays)
{
    Pixel pixel = pixel_of(launch, launch.first_tile + blockIdx.x, threadIdx.x);
    if (!is_in_image(launch, pixel)) return;
    uint ray = ray_index(pixel);
    Segments all =
        cross_tets(scene, launch.trace, sums, absorbs, __ldg(rays + ray), __ldg(rays + ray_count(launch) + ray));
    uint2* pairs = reinterpret_cast<uint2*>(output + output_word(launch, pixel));
    pairs[0] = make_uint2(all.first, all.last);
    pairs[1] = make_uint2(all.total, all.hash);
    pairs[2] = make_uint2(all.reversed, all.crossings);
}

extern "C" __global__ void ENTRY(segments_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                               const uint4* __restrict__ rays)
{
    cross_from_pixel(scene, launch, NO_SUMS, false, output, rays);
}

extern "C" __global__ void ENTRY(tally_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                            const uint4* __restrict__ rays)
{
    cross_from_pixel(scene, launch, output + GUARD_WORDS + HIT_WORDS * ray_count(launch), false, output, rays);
}

extern "C" __global__ void ENTRY(absorb_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                             const uint4* __restrict__ rays)
{
    cross_from_pixel(scene, launch, NO_SUMS, true, output, rays);
}
#endif

#ifdef SEARCHES_EXITS
// One exit search per thread, one tile per block.
extern "C" __global__ void ENTRY(search_tiles_, KERNEL_NAME)(SceneView scene, LaunchParams launch, uint* output,
                                                             const uint4* __restrict__ rays)
{
    Pixel pixel = pixel_of(launch, launch.first_tile + blockIdx.x, threadIdx.x);
    if (!is_in_image(launch, pixel)) return;
    uint ray = ray_index(pixel);
    uint count = ray_count(launch);
    output[GUARD_WORDS + ray] =
        search_exit(scene, __ldg(rays + ray), __ldg(rays + count + ray), __ldg(rays + 2u * count + ray));
}
#endif
