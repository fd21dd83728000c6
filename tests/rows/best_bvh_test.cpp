#include "bench/rows/best_bvh.h"

#include "bench/measuring/comparison.h"
#include "tests/support/row_runs.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Contender contender(const std::string& name, const std::string& arena, double rate)
{
    return {.name = name,
            .arena = arena,
            .is_bvh = name.starts_with("bvh"),
            .is_embree = name.find("embree") != std::string::npos,
            .is_single = name.find("packet") == std::string::npos,
            .mrays_per_s = rate};
}

const std::vector<Contender> host = {contender("cdt half32", "host", 33),
                                     contender("cdt half32 packets", "host", 200),
                                     contender("bvh bvh2", "host", 21),
                                     contender("bvh cwbvh", "host", 12),
                                     contender("bvh single on embree", "host", 36),
                                     contender("bvh packet16 on embree", "host", 110),
                                     contender("bvh rt", "a GPU", 9000),
                                     contender("cdt half32 on cuda", "a GPU", 17000),
                                     contender("cdt half32 on opencl", "opencl:0", 30)};

/// A million rays in that many seconds, and the time of the build.
RowRecord row_of(Structure structure, Layout layout, Method method, const std::string& backend, DeviceKind kind,
                 double seconds, double build_s = 1)
{
    RowRecord row;
    row.key = {"bunny", backend, {structure, method, layout}, RayKind::primary, TetOrder::chains, 0};
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

TEST(BestBvh, is_the_fastest_of_all_entry_points_on_the_same_rays_and_device)
{
    EXPECT_EQ(best_bvh(host, 0), 5u);
    EXPECT_EQ(best_bvh(host, 2), 5u) << "of BVHs too";
    EXPECT_EQ(best_bvh(host, 5), 5u) << "it is its own";
    EXPECT_EQ(best_bvh(host, 7), 6u);
    EXPECT_FALSE(best_bvh(host, 8)) << "that device is without a BVH";
}

TEST(BestBvh, one_ray_at_a_time_is_of_ours_or_of_embrees)
{
    EXPECT_EQ(best_bvh(host, 0, BvhKind::our_single), 2u);
    EXPECT_EQ(best_bvh(host, 0, BvhKind::embree_single), 4u);
    EXPECT_FALSE(best_bvh(host, 7, BvhKind::embree_single));
    for (const Schedule schedule : {Schedule::tiles, Schedule::native, Schedule::persistent, Schedule::pipeline})
        EXPECT_TRUE(is_single_ray({.schedule = schedule}));
    EXPECT_FALSE(is_single_ray({.schedule = Schedule::packets}));
    EXPECT_TRUE(is_single_ray({Structure::bvh, Method::single, Layout::embree}));
    EXPECT_FALSE(is_single_ray({Structure::bvh, Method::packet16, Layout::embree}));
}

// The rule of every printed ratio: a BVH is called the fastest only if it is, and is named in any case.
TEST(BestBvh, a_text_names_the_bvh_and_calls_no_other_the_fastest)
{
    for (std::size_t i = 0; i < host.size(); ++i) {
        if (!host[i].is_bvh) continue;
        const std::string text = bvh_text(host, i);
        EXPECT_NE(text.find(host[i].name), std::string::npos) << text;
        EXPECT_EQ(text.find("the fastest BVH") != std::string::npos, i == 5 || i == 6) << text;
    }
    auto slower = host;
    slower[5].mrays_per_s = 20;
    EXPECT_EQ(bvh_text(slower, 5), "bvh packet16 on embree");
    EXPECT_EQ(bvh_text(slower, 4), "the fastest BVH, bvh single on embree");
}

TEST(BestBvh, rows_compare_with_embrees_on_the_host_and_with_their_own_bvh_elsewhere)
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

TEST(BestBvh, a_gpus_rows_compare_with_those_of_all_its_apis)
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

TEST(BestBvh, other_rays_and_rows_without_a_rate_do_not_count)
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
