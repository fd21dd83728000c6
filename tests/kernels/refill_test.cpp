// CUDA's persistent threads on BVHs, without a GPU: warps of 32 lanes that go in lockstep give their ended lanes new
// rays in the middle of the others' traversals, and the hits are openmp's.
#include "core/device/given_quads.h"
#include "core/device/scene_buffers.h"
#include "tests/kernels/refill_probe.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <numeric>

namespace tetrace::test {

std::array<std::uint32_t, Warp::lanes> Warp::exchange(std::uint32_t lane, std::uint32_t word)
{
    words_[lane] = word;
    meeting_.arrive_and_wait();
    const auto all = words_;
    meeting_.arrive_and_wait();
    return all;
}

std::uint32_t Warp::ballot(std::uint32_t lane, bool vote)
{
    const auto votes = exchange(lane, vote ? 1u << lane : 0u);
    const std::uint32_t all = std::accumulate(votes.begin(), votes.end(), 0u);
    if (lane == 0) last_vote_ = all;
    return all;
}

std::uint32_t Warp::shuffle(std::uint32_t lane, std::uint32_t value, std::uint32_t from)
{
    if (lane == 0 && std::popcount(last_vote_) < int{lanes}) ++refills_;
    return exchange(lane, value)[from];
}

namespace {

struct Tree {
    Layout layout;
    std::size_t (*trace_by_warps)(const WarpLaunch&);
};

class RefilledLanes : public ::testing::TestWithParam<Tree> {
protected:
    [[nodiscard]] KernelId kernel(Task task) const
    {
        return {.structure = Structure::bvh, .method = Method::single, .layout = GetParam().layout, .task = task};
    }
    void expect_openmps_hits(const TraceJob& job, const std::vector<Quad>& rays = {}) const
    {
        const Task task = rays.empty() ? Task::trace : Task::rays;
        const auto on_host = openmp_backend().open(0, kernel(task), {&cubes.scene.mesh, &packed}, {.threads = 2});
        if (!rays.empty()) on_host->set_rays(rays);
        for (const unsigned tile_height : {4u, 8u}) {
            std::vector<std::uint32_t> output(output_words(job, task), POISON);
            const LaunchParams params = launch_params(job, packed.divisions, tile_height, TetParts{}.log2_bytes);
            EXPECT_GT(GetParam().trace_by_warps({packed, params, rays, output}), 10u) << "lanes were refilled";
            EXPECT_EQ(different_rays(hits_in(output), traced(*on_host, job), 0), 0u) << tile_height;
        }
    }

    GivenScene cubes{40, false, 6};
    PackedScene packed = make_bvh_scene(cubes.scene.mesh, GetParam().layout);

private:
    static std::vector<Hit> hits_in(const std::vector<std::uint32_t>& output)
    {
        std::vector<Hit> hits((output.size() - 2 * GUARD_WORDS) / HIT_WORDS);
        std::memcpy(hits.data(), output.data() + GUARD_WORDS, hits.size() * sizeof(Hit));
        EXPECT_EQ(std::count(output.begin(), output.begin() + GUARD_WORDS, POISON), GUARD_WORDS);
        EXPECT_EQ(std::count(output.end() - GUARD_WORDS, output.end(), POISON), GUARD_WORDS);
        return hits;
    }
};

} // namespace

TEST_P(RefilledLanes, hit_what_openmp_hits_in_images_whose_tiles_are_cut_off)
{
    TraceJob job = cubes.job;
    job.width = 37;
    job.height = 35;
    expect_openmps_hits(job);
}

TEST_P(RefilledLanes, hit_what_openmp_hits_with_given_rays_and_where_any_hit_will_do)
{
    for (const RayKind kind : {RayKind::random, RayKind::ao}) {
        const RaySet set = make_rays(kind, cubes.source());
        expect_openmps_hits(given_job(set.rays.size(), 1, set.any_hit), given_quads_offset(set, cubes.scene.mesh));
    }
}

INSTANTIATE_TEST_SUITE_P(each, RefilledLanes,
                         ::testing::Values(Tree{Layout::bvh2, trace_by_warps_bvh2},
                                           Tree{Layout::cwbvh, trace_by_warps_cwbvh}),
                         [](const auto& test) { return std::string(name_of(test.param.layout)); });

} // namespace tetrace::test
