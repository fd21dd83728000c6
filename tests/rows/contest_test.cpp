#include "bench/rows/contest.h"

#include "bench/measuring/comparison.h"
#include "tests/support/row_runs.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A million rays in that many seconds, and the time of the build.
RowRecord row_of(Structure structure, Layout layout, Method method, const std::string& backend, DeviceKind kind,
                 double seconds, double build_s = 1)
{
    RowRecord row;
    row.key = {"bunny", backend, {structure, method, layout}, RayKind::primary, TetOrder::chains, 0};
    row.device.name = "a device";
    row.device.kind = kind;
    Traced result;
    result.totals.rays = 1'000'000;
    row.outcome = result;
    row.samples_s = {0.99 * seconds, seconds, 1.01 * seconds, seconds, 0.99 * seconds, 1.01 * seconds};
    set_setup_cost(row, {build_s, 0, 1});
    return row;
}

RowRecord tets_on(const std::string& backend, DeviceKind kind, double seconds, double build_s = 1)
{
    return row_of(Structure::cdt, Layout::tet80, Method::maria, backend, kind, seconds, build_s);
}

RowRecord bvh2_on(const std::string& backend, DeviceKind kind, double seconds, double build_s = 1)
{
    return row_of(Structure::bvh, Layout::bvh2, Method::single, backend, kind, seconds, build_s);
}

RowRecord embrees(Method method, double seconds)
{
    return row_of(Structure::bvh, Layout::embree, method, "embree", DeviceKind::cpu, seconds);
}

} // namespace

TEST(Contest, the_fastest_bvh_is_of_all_entry_points_or_one_ray_at_a_time_of_ours_or_of_embrees)
{
    auto rows = list(tets_on("openmp", DeviceKind::cpu, 3), bvh2_on("openmp", DeviceKind::cpu, 5),
                     embrees(Method::single, 3), embrees(Method::packet16, 1), bvh2_on("cuda", DeviceKind::gpu, 0.1));
    rows[4].device.uuid = "a";
    const auto contests = contests_of(rows);
    ASSERT_EQ(contests.size(), 2u);
    EXPECT_EQ(contests[0].fastest(Walk::any), &rows[0]);
    EXPECT_EQ(contests[0].fastest(Rival::any), &rows[3]);
    EXPECT_EQ(contests[0].fastest(Rival::single), &rows[2]);
    EXPECT_EQ(contests[0].fastest(Rival::our_single), &rows[1]);
    EXPECT_EQ(contests[0].fastest(Rival::embree_single), &rows[2]);
    EXPECT_EQ(contests[1].fastest(Rival::any), &rows[4]) << "another device";
    EXPECT_EQ(contests[1].fastest(Walk::any), nullptr);
}

TEST(Contest, packets_and_streams_are_not_one_ray_at_a_time)
{
    for (const Schedule schedule : {Schedule::tiles, Schedule::native, Schedule::persistent, Schedule::pipeline})
        EXPECT_TRUE(is_single_ray({.schedule = schedule}));
    EXPECT_FALSE(is_single_ray({.schedule = Schedule::packets}));
    EXPECT_TRUE(is_single_ray({Structure::bvh, Method::single, Layout::embree}));
    EXPECT_FALSE(is_single_ray({Structure::bvh, Method::packet16, Layout::embree}));
}

// The rule of every printed ratio: a BVH is called the fastest only if it is, and is named in any case.
TEST(Contest, a_text_names_the_bvh_and_calls_no_other_the_fastest)
{
    const auto rows = list(tets_on("openmp", DeviceKind::cpu, 3), bvh2_on("openmp", DeviceKind::cpu, 5),
                           embrees(Method::single, 3), embrees(Method::packet16, 1));
    const auto contests = contests_of(rows);
    EXPECT_EQ(contests.at(0).bvh_text(rows[3], row_label(rows[3].key)), "the fastest BVH, bvh packet16 on embree");
    for (const std::size_t i : {1u, 2u})
        EXPECT_EQ(contests.at(0).bvh_text(rows[i], row_label(rows[i].key)), row_label(rows[i].key));
}

TEST(Contest, rows_of_a_scene_that_could_not_be_loaded_are_on_the_host_or_in_no_contest)
{
    auto rows =
        list(tets_on("openmp", DeviceKind::cpu, 3), embrees(Method::single, 3), bvh2_on("cuda", DeviceKind::gpu, 1));
    for (RowRecord& row : rows)
        row.device = {};
    const auto contests = contests_of(rows);
    ASSERT_EQ(contests.size(), 1u);
    EXPECT_EQ(contests[0].rows.size(), 2u);
}

TEST(Contest, rows_compare_with_embrees_on_the_host_and_with_their_own_bvh_elsewhere)
{
    const auto rows =
        list(tets_on("openmp", DeviceKind::cpu, 2), bvh2_on("openmp", DeviceKind::cpu, 3), embrees(Method::single, 2),
             embrees(Method::packet16, 1), tets_on("opencl", DeviceKind::emulated, 2),
             bvh2_on("opencl", DeviceKind::emulated, 4), bvh2_on("vulkan", DeviceKind::emulated, 0.5));
    const auto found = compare_with_best_bvh(rows);
    const std::vector<std::size_t> references = {3, 3, 3, 3, 5, 5, 6};
    const std::vector<double> ratios = {0.5, 1.0 / 3, 0.5, 1, 2, 1, 1};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        ASSERT_TRUE(found[i].has_value()) << i;
        EXPECT_EQ(found[i]->reference, &rows[references[i]]) << i;
        EXPECT_DOUBLE_EQ(found[i]->ratio, ratios[i]) << i;
        EXPECT_EQ(found[i]->interval.has_value(), &rows[i] != found[i]->reference) << i;
    }
    EXPECT_TRUE(found[0]->interval->contains(0.5));
}

TEST(Contest, a_gpus_rows_compare_with_those_of_all_its_apis)
{
    auto rows = list(tets_on("cuda", DeviceKind::gpu, 1), bvh2_on("cuda", DeviceKind::gpu, 3),
                     bvh2_on("vulkan", DeviceKind::gpu, 2), bvh2_on("vulkan", DeviceKind::gpu, 0.1));
    for (RowRecord& row : rows)
        row.device.uuid = "a";
    rows[3].device.uuid = "b";
    rows[3].key.device = 1;
    EXPECT_EQ(compare_with_best_bvh(rows)[0]->reference, &rows[2]);
    EXPECT_EQ(compare_with_best_bvh(rows)[3]->reference, &rows[3]) << "another GPU";
}

TEST(Contest, other_rays_and_rows_without_a_rate_do_not_count)
{
    auto rows = list(tets_on("openmp", DeviceKind::cpu, 2), bvh2_on("openmp", DeviceKind::cpu, 3),
                     embrees(Method::packet16, 1));
    rows[2].key.rays = RayKind::ao;
    EXPECT_EQ(compare_with_best_bvh(rows)[0]->reference, &rows[1]);
    std::get<Traced>(rows[1].outcome).different = 1;
    EXPECT_FALSE(compare_with_best_bvh(rows)[0].has_value());
    rows[2].key.rays = RayKind::primary;
    EXPECT_EQ(compare_with_best_bvh(rows)[0]->reference, &rows[2]);
}

TEST(PaidBuild, counts_both_builds_and_the_rows_own_seconds)
{
    using When = PaidBuild::When;
    const auto paid = [](double tets_s, double build_s) {
        const auto rows = list(tets_on("openmp", DeviceKind::cpu, tets_s, build_s),
                               bvh2_on("openmp", DeviceKind::cpu, 2, 1), embrees(Method::packet16, 3));
        return paid_build(rows[0], compare_with_best_bvh(rows)[0]).value();
    };
    // A microsecond a ray less; 10 s are paid after 10 million rays, which take 10 s.
    EXPECT_EQ(paid(1, 11).when, When::later);
    EXPECT_NEAR(paid(1, 11).rays, 1e7, 1);
    EXPECT_NEAR(paid(1, 11).tracing_s, 10, 1e-6);
    EXPECT_EQ(paid(1, 0.5).when, When::at_once);
    EXPECT_EQ(paid(4, 11).when, When::never) << "it is slower";
    EXPECT_EQ(paid(4, 0.5).when, When::never) << "although it is built first";
    EXPECT_EQ(paid(2, 11).when, When::unclear) << "the interval contains 1";
}

TEST(PaidBuild, is_of_tets_whose_build_times_are_known)
{
    auto rows = list(tets_on("openmp", DeviceKind::cpu, 1, 11), bvh2_on("openmp", DeviceKind::cpu, 2, 1));
    const auto best = compare_with_best_bvh(rows);
    EXPECT_FALSE(paid_build(rows[1], best[1])) << "a BVH";
    EXPECT_FALSE(paid_build(rows[0], std::nullopt)) << "no BVH next to it";
    rows[1].setup = {};
    EXPECT_FALSE(paid_build(rows[0], best[0])) << "of an older result";
}
