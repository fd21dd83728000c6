// The persistent entries of backends/cuda/kernel.cu on warps of many lanes, for refill_test.cpp: compiled once for each
// layout of BVHs, as kernel by_warps_bvh2 and so on. The host emulation's own warps have one lane.
#include "tests/kernels/refill_probe.h"
#include "backends/cuda_host/shim.h"
#include "kernels/layouts/layout.h"

#include <bit>
#include <list>
#include <thread>
#include <vector>

namespace {

thread_local tetrace::test::Warp* current_warp = nullptr;
thread_local tetrace::test::Patience patience;

#undef warpSize
#define warpSize (::tetrace::test::Warp::lanes)
#define __ballot_sync(lanes, vote) current_warp->ballot(lanes, vote)
#define __shfl_sync(lanes, value, from) current_warp->shuffle(value, from)
#define ENOUGH_LANES (patience.enough_lanes)
#define PUTS_TRIANGLES_OFF (patience.puts_triangles_off)
#define COUNT_NODE() ++tetrace::test::Warp::since_vote.nodes
#define COUNT_TRIANGLE() ++tetrace::test::Warp::since_vote.triangles
#include "backends/cuda/kernel.cu"

constexpr uint max_warps = 2;
thread_local uint group_words[STACK_ENTRY_WORDS * STACK_TOP * max_warps * warpSize];

const uint4* quads(std::span<const tetrace::Quad> all)
{
    return reinterpret_cast<const uint4*>(all.data());
}

void run_thread(uint thread, const tetrace::test::WarpLaunch& launch, uint* counter)
{
    tetrace::cuda_host::current_thread = {thread, 0, 0};
    tetrace::cuda_host::block_size = {launch.warps * warpSize, 1, 1};
    const SceneView scene{quads(launch.packed.nodes), quads(launch.packed.leaf_triangles), launch.packed.divisions, {}};
    const auto params = std::bit_cast<LaunchParams>(launch.params);
    const uint tiles = tetrace::tile_count(launch.params);
    uint* const output = launch.output.data();
    patience = launch.patience;
    if (launch.rays.empty())
        ENTRY(trace_persistent_, KERNEL_NAME)(scene, params, output, counter, tiles);
    else
        ENTRY(rays_persistent_, KERNEL_NAME)(scene, params, output, counter, tiles, quads(launch.rays));
}

} // namespace

namespace tetrace::test {

WarpCounts ENTRY(trace_, KERNEL_NAME)(const WarpLaunch& launch)
{
    std::vector<Warp> block(launch.warps);
    uint counter = 0;
    {
        std::vector<std::jthread> threads;
        for (uint thread = 0; thread < launch.warps * warpSize; ++thread)
            threads.emplace_back([&, thread] {
                current_warp = &block[thread / warpSize];
                current_warp->join(thread % warpSize);
                run_thread(thread, launch, &counter);
            });
    }
    WarpCounts all;
    for (const Warp& warp : block) {
        all.refills += warp.refills();
        all.visits.nodes += warp.visits().nodes;
        all.visits.triangles += warp.visits().triangles;
    }
    return all;
}

} // namespace tetrace::test
