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
#include <iterator>
#include <numeric>
#include <utility>

namespace tetrace::test {

thread_local Visits Warp::since_vote;

namespace {

thread_local std::uint32_t own_lane = 0;
constexpr std::uint32_t all_lanes = 0xFFFFFFFFu;

bool is_first_of(std::uint32_t named)
{
    return static_cast<std::uint32_t>(std::countr_zero(named)) == own_lane;
}

} // namespace

Warp::Warp()
{
    for (std::uint32_t count = 1; count <= lanes; ++count)
        meetings_.emplace_back(count);
}

void Warp::join(std::uint32_t lane)
{
    own_lane = lane;
}

std::array<std::uint32_t, Warp::lanes> Warp::exchange(std::uint32_t named, std::uint32_t word)
{
    auto& meeting = *std::next(meetings_.begin(), std::popcount(named) - 1);
    words_[own_lane] = word;
    lane_visits_[own_lane] = std::exchange(since_vote, {});
    meeting.arrive_and_wait();
    std::array<std::uint32_t, lanes> all{};
    Visits most;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        if ((named >> lane & 1u) == 0) continue;
        all[lane] = words_[lane];
        most.nodes = std::max(most.nodes, lane_visits_[lane].nodes);
        most.triangles = std::max(most.triangles, lane_visits_[lane].triangles);
    }
    if (is_first_of(named)) {
        visits_.nodes += most.nodes;
        visits_.triangles += most.triangles;
    }
    meeting.arrive_and_wait();
    return all;
}

std::uint32_t Warp::ballot(std::uint32_t named, bool vote)
{
    const auto votes = exchange(named, vote ? 1u << own_lane : 0u);
    const std::uint32_t all = std::accumulate(votes.begin(), votes.end(), 0u);
    if (is_first_of(named)) last_vote_ = all;
    return all;
}

std::uint32_t Warp::shuffle(std::uint32_t value, std::uint32_t from)
{
    if (is_first_of(all_lanes) && last_vote_ != 0) ++refills_;
    return exchange(all_lanes, value)[from];
}

namespace {

struct Tree {
    Layout layout;
    WarpCounts (*trace_by_warps)(const WarpLaunch&);
};

class RefilledLanes : public ::testing::TestWithParam<Tree> {
protected:
    [[nodiscard]] KernelId kernel(Task task) const
    {
        return {.structure = Structure::bvh, .method = Method::single, .layout = GetParam().layout, .task = task};
    }
    void expect_openmps_hits(const SceneData& scene, const TraceJob& job, const std::vector<Quad>& rays = {}) const
    {
        const Task task = rays.empty() ? Task::trace : Task::rays;
        const auto on_host = openmp_backend().open(0, kernel(task), scene, {.threads = 2});
        if (!rays.empty()) on_host->set_rays(rays);
        for (const unsigned tile_height : {4u, 8u}) {
            std::vector<std::uint32_t> output(2 * GUARD_WORDS + HIT_WORDS * job.rays(), POISON);
            const LaunchParams params =
                launch_params(job, domain_of(*scene.packed), tile_height, TetParts{}.log2_bytes);
            const WarpCounts counts = GetParam().trace_by_warps({*scene.packed, params, rays, output});
            EXPECT_GT(counts.refills, 10u) << "lanes were refilled";
            EXPECT_EQ(different_rays(hits_in(output), traced(*on_host, job), 0), 0u) << tile_height;
        }
    }
    void expect_openmps_hits(const TraceJob& job, const std::vector<Quad>& rays = {}) const
    {
        expect_openmps_hits({&cubes.scene.mesh, &packed}, job, rays);
    }

    /// Of one warp, to which rays come in one order.
    [[nodiscard]] Visits visits(const RaySet& set, Patience patience) const
    {
        const TraceJob job = given_job(set.rays.size(), 1, false);
        const std::vector<Quad> rays = given_quads_offset(set, cubes.scene.mesh);
        std::vector<std::uint32_t> output(2 * GUARD_WORDS + HIT_WORDS * job.rays(), POISON);
        const LaunchParams params = launch_params(job, domain_of(packed), 4, TetParts{}.log2_bytes);
        return GetParam().trace_by_warps({packed, params, rays, output, 1, patience}).visits;
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

TEST_P(RefilledLanes, go_through_fewer_nodes_and_triangles_than_those_of_whole_warps)
{
    for (const RayKind kind : {RayKind::diffuse, RayKind::random}) {
        const RaySet set = make_rays(kind, cubes.source());
        const Visits whole_warps = visits(set, {.enough_lanes = 1, .puts_triangles_off = false});
        const Visits refilled = visits(set, {});
        EXPECT_LT(10 * refilled.nodes, 9 * whole_warps.nodes);
        EXPECT_LT(10 * refilled.triangles, 9 * whole_warps.triangles);
    }
}

TEST_P(RefilledLanes, that_put_triangles_off_find_room_on_a_full_stack)
{
    const FullStacks full(GetParam().layout);
    expect_openmps_hits({&full.mesh, &full.packed}, given_job(full.rays.rays.size(), 1, false),
                        given_quads_offset(full.rays, full.mesh));
}

INSTANTIATE_TEST_SUITE_P(each, RefilledLanes,
                         ::testing::Values(Tree{Layout::bvh2, trace_by_warps_bvh2},
                                           Tree{Layout::bvh4, trace_by_warps_bvh4},
                                           Tree{Layout::cwbvh, trace_by_warps_cwbvh}),
                         [](const auto& test) { return std::string(name_of(test.param.layout)); });

} // namespace tetrace::test
