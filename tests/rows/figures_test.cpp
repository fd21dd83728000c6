#include "bench/measuring/figures.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

/// A row of 4,000,000 rays and 40,000,000 steps with a median of 0.5 s; figures are worked out by hand.
RowRecord timed_row(Layout layout = Layout::tet80)
{
    RowRecord row;
    row.key = {"a", "openmp", {}, RayKind::primary, TetOrder::chains};
    row.key.kernel.layout = layout;
    row.device.kind = DeviceKind::cpu;
    Traced result;
    result.totals.rays = 4'000'000;
    result.totals.hits = 1'000'000;
    result.totals.misses = 3'000'000;
    result.totals.hit_steps = 25'000'000;
    result.totals.miss_steps = 15'000'000;
    row.outcome = result;
    row.samples_s = {0.5, 0.25, 0.5, 1.0, 0.5};
    return row;
}

/// Embree's single rays, four times as fast as timed_row().
RowRecord single_row(const std::string& scene)
{
    RowRecord row = timed_row(Layout::embree);
    row.key.scene = scene;
    row.key.kernel.structure = Structure::bvh;
    row.key.kernel.method = Method::single;
    auto& totals = std::get<Traced>(row.outcome).totals;
    totals.hit_steps = totals.miss_steps = 0;
    row.samples_s = {0.125, 0.125, 0.125};
    return row;
}

} // namespace

TEST(Figures, rates_are_counts_over_the_median)
{
    const auto figures = figures_of(timed_row());
    ASSERT_TRUE(figures.has_value());
    EXPECT_DOUBLE_EQ(figures->kernel_s.median, 0.5);
    EXPECT_DOUBLE_EQ(figures->mrays_per_s, 8);
    EXPECT_DOUBLE_EQ(figures->mhits_per_s.value(), 2);
    EXPECT_DOUBLE_EQ(figures->msteps_per_s.value(), 80);
}

TEST(Figures, shares_are_of_all_rays_and_left_out_if_they_are_not_known)
{
    Traced result = *traced(timed_row());
    EXPECT_DOUBLE_EQ(ray_shares(result).hit.value(), 0.25);
    EXPECT_FALSE(ray_shares(result).enter.has_value());
    result.entering = 3'000'000;
    EXPECT_DOUBLE_EQ(ray_shares(result).enter.value(), 0.75);
    EXPECT_FALSE(ray_shares(Traced{}).hit.has_value()) << "no rays";
    RowRecord misses = timed_row();
    std::get<Traced>(misses.outcome).totals.hits = 0;
    EXPECT_FALSE(figures_of(misses)->mhits_per_s.has_value()) << "no rate is 0";
}

TEST(Figures, entering_rays_add_up_over_the_views)
{
    Traced result;
    ImageVerdict image;
    image.totals.rays = 4;
    image.entering = 3;
    result.add(image);
    image.entering = 0;
    result.add(image);
    EXPECT_EQ(result.entering, 3u);
}

// Three vertices and a face: 36 + 8 bytes in tet80, four rows of 16 in tet96; a fourth vertex is 12 or 16 bytes more.
TEST(Figures, bandwidth_is_steps_times_what_a_step_loads)
{
    EXPECT_DOUBLE_EQ(bytes_per_step({}), 44);
    EXPECT_DOUBLE_EQ(bytes_per_step({Structure::cdt, Method::maria, Layout::tet96}), 64);
    EXPECT_DOUBLE_EQ(bytes_per_step({Structure::cdt, Method::plane, Layout::tet80}), 56);
    EXPECT_DOUBLE_EQ(bytes_per_step({Structure::cdt, Method::project, Layout::tet20}), 24) << "a vertex and two words";
    EXPECT_DOUBLE_EQ(bytes_per_step({Structure::cdt, Method::project, Layout::tet16}), 32) << "a vertex and a row";
    EXPECT_DOUBLE_EQ(bytes_per_step({Structure::cdt, Method::ms06, Layout::tet80}), 52);
    EXPECT_DOUBLE_EQ(bytes_per_step({Structure::cdt, Method::stp, Layout::tet96}), 64 + 32.0 / 3);
    const auto crossing = [](Layout layout, Task task) {
        return bytes_per_step({.method = Method::project, .layout = layout, .task = task});
    };
    EXPECT_DOUBLE_EQ(crossing(Layout::tet80, Task::segments), 56) << "four vertices and a face";
    EXPECT_DOUBLE_EQ(crossing(Layout::half32, Task::segments), 80) << "four vertices and a row of links";
    EXPECT_DOUBLE_EQ(crossing(Layout::tet64, Task::absorb), 64) << "the tet's line";
    EXPECT_DOUBLE_EQ(crossing(Layout::tet64, Task::tally), 72) << "and a word that is added to";
    EXPECT_DOUBLE_EQ(figures_of(timed_row(Layout::tet80))->gb_per_s.value(), 3.52);
    EXPECT_DOUBLE_EQ(figures_of(timed_row(Layout::tet96))->gb_per_s.value(), 5.12);
}

TEST(Figures, a_structure_without_steps_has_no_step_rate_and_no_bandwidth)
{
    const auto figures = figures_of(single_row("a"));
    ASSERT_TRUE(figures.has_value());
    EXPECT_DOUBLE_EQ(figures->mrays_per_s, 32);
    EXPECT_FALSE(figures->msteps_per_s.has_value());
    EXPECT_FALSE(figures->gb_per_s.has_value());
    EXPECT_FALSE(mean_steps(traced(single_row("a"))->totals).all.has_value());
}

TEST(Figures, latency_is_of_launches_of_one_view_and_the_fixed_cost_of_the_line_through_both)
{
    RowRecord row = timed_row();
    EXPECT_FALSE(figures_of(row)->latency_s.has_value());
    row.launches = {1, 4};
    row.samples_s = {0.5, 0.51, 0.5, 0.49, 0.5, 0.5};
    row.latency_samples_s = {0.8, 0.81, 0.8, 0.79, 0.8};
    const auto figures = figures_of(row);
    EXPECT_DOUBLE_EQ(figures->mrays_per_s, 8) << "throughput";
    EXPECT_DOUBLE_EQ(figures->latency_s.value(), 0.2) << "of one of four views";
    EXPECT_DOUBLE_EQ(figures->latency_mrays_per_s.value(), 5);
    EXPECT_NEAR(figures->fixed_s.value(), 0.1, 1e-12) << "0.3 s in three more launches";
    EXPECT_NEAR(figures->s_per_mray.value(), 0.1, 1e-12) << "0.4 s of 4 million rays";
    row.launches = {4, 4};
    row.latency_samples_s.clear();
    EXPECT_DOUBLE_EQ(figures_of(row)->latency_s.value(), 0.125) << "its samples have a launch for each view";
    EXPECT_FALSE(figures_of(row)->fixed_s.has_value());
}

TEST(Figures, of_launches_in_flight_have_a_latency_only_from_launches_by_themselves_and_no_fixed_cost)
{
    RowRecord row = timed_row();
    row.key.in_flight = 2;
    row.launches = {4, 4};
    EXPECT_FALSE(figures_of(row)->latency_s.has_value()) << "its launches overlap";
    row.latency_samples_s = {0.8, 0.81, 0.8, 0.79, 0.8};
    EXPECT_DOUBLE_EQ(figures_of(row)->latency_s.value(), 0.2);
    row.launches = {1, 4};
    row.samples_s = {0.5, 0.51, 0.5, 0.49, 0.5, 0.5};
    EXPECT_DOUBLE_EQ(figures_of(row)->latency_s.value(), 0.2);
    EXPECT_FALSE(figures_of(row)->fixed_s.has_value());
    EXPECT_FALSE(figures_of(row)->s_per_mray.has_value());
}

TEST(Figures, overhead_is_the_median_of_wall_minus_device_seconds_sample_by_sample)
{
    RowRecord row = timed_row();
    EXPECT_FALSE(figures_of(row)->overhead_s.has_value());
    row.wall_samples_s = {0.5625, 0.375, 0.75, 1.0, 0.53125};
    EXPECT_DOUBLE_EQ(figures_of(row)->overhead_s.value(), 0.0625);
    EXPECT_DOUBLE_EQ(figures_of(row)->wall_s.value(), 0.5625);
}

TEST(Figures, mean_steps_are_apart_for_hits_and_misses)
{
    const MeanSteps mean = mean_steps(traced(timed_row())->totals);
    EXPECT_DOUBLE_EQ(mean.all.value(), 10);
    EXPECT_DOUBLE_EQ(mean.hit.value(), 25);
    EXPECT_DOUBLE_EQ(mean.miss.value(), 5);
}

TEST(Figures, the_ratio_is_the_rows_rate_over_that_of_single_rays_on_the_same_scene)
{
    std::vector<RowRecord> rows;
    rows.push_back(single_row("b"));
    std::get<Traced>(rows.back().outcome).totals.rays *= 3; // another scene's: must not be taken
    rows.push_back(timed_row());
    rows.push_back(single_row("a"));
    EXPECT_DOUBLE_EQ(ratio_to_single(rows[1], rows).value(), 0.25);
    EXPECT_DOUBLE_EQ(ratio_to_single(rows[2], rows).value(), 1);
    rows.pop_back();
    EXPECT_FALSE(ratio_to_single(rows[1], rows).has_value());
}

TEST(Figures, the_ratio_is_over_the_faster_of_embrees_single_rays)
{
    std::vector<RowRecord> rows;
    rows.push_back(timed_row());
    for (const Layout layout : {Layout::embree, Layout::embree_medium}) {
        rows.push_back(single_row(rows[0].key.scene));
        rows.back().key.kernel.layout = layout;
    }
    rows[1].samples_s = {0.25, 0.25, 0.25};
    EXPECT_DOUBLE_EQ(ratio_to_single(rows[0], rows).value(), 0.25);
    EXPECT_DOUBLE_EQ(ratio_to_single(rows[1], rows).value(), 0.5);
    rows[2].key.kernel.method = Method::packet16;
    EXPECT_DOUBLE_EQ(ratio_to_single(rows[0], rows).value(), 0.5) << "packets are not single rays";
}

TEST(Figures, the_ratio_is_over_single_rays_of_the_same_kind_and_order)
{
    std::vector<RowRecord> rows;
    rows.push_back(single_row("a"));
    rows.push_back(timed_row());
    rows[1].key.ray_order = RayOrder::morton;
    EXPECT_FALSE(ratio_to_single(rows[1], rows).has_value());
    rows[0].key.ray_order = RayOrder::morton;
    EXPECT_TRUE(ratio_to_single(rows[1], rows).has_value());
    rows[1].key.rays = RayKind::ao;
    EXPECT_FALSE(ratio_to_single(rows[1], rows).has_value());
}

TEST(Figures, a_gpus_row_is_not_compared_with_the_hosts_single_rays)
{
    std::vector<RowRecord> rows;
    rows.push_back(single_row("a"));
    rows.push_back(timed_row());
    rows[1].device.kind = DeviceKind::gpu;
    EXPECT_FALSE(ratio_to_single(rows[1], rows).has_value());
    rows[1].device.kind = DeviceKind::emulated;
    EXPECT_TRUE(ratio_to_single(rows[1], rows).has_value());
}

TEST(Figures, a_row_has_rates_where_it_is_ok_or_flawed_and_was_timed)
{
    RowRecord flawed = timed_row();
    std::get<Traced>(flawed.outcome).verdicts.wrong = 1;
    EXPECT_TRUE(figures_of(flawed).has_value());
    RowRecord lost = timed_row();
    std::get<Traced>(lost.outcome).verdicts.lost = 1;
    EXPECT_TRUE(figures_of(lost).has_value());
    RowRecord different = timed_row();
    std::get<Traced>(different.outcome).different = 1;
    EXPECT_FALSE(figures_of(different).has_value());
    RowRecord untimed = timed_row();
    untimed.samples_s.clear();
    EXPECT_FALSE(figures_of(untimed).has_value());
    RowRecord failed = timed_row();
    failed.outcome = Failed{ErrorKind::internal, "driver gone"};
    EXPECT_FALSE(figures_of(failed).has_value());
}

namespace {

RowRecord row_with(Outcome outcome, Method method = Method::maria)
{
    RowRecord row;
    row.key.kernel.method = method;
    row.outcome = std::move(outcome);
    return row;
}

Traced judged(std::uint64_t wrong, std::uint64_t lost, std::uint64_t different)
{
    Traced result;
    result.verdicts.wrong = wrong;
    result.verdicts.lost = lost;
    result.different = different;
    return result;
}

/// The exit code of two rows that are ok and a third; flawed ones pass in `bench` and with --allow-flawed.
int code_with(Outcome outcome, bool flawed_passes)
{
    std::vector<RowRecord> rows;
    rows.push_back(row_with(Traced{}));
    rows.push_back(row_with(std::move(outcome)));
    rows.push_back(row_with(Traced{}));
    return exit_code(rows, flawed_passes);
}

} // namespace

TEST(ExitCodes, rows_that_are_ok_skipped_or_unsupported_are_no_failure)
{
    for (const bool passes : {false, true}) {
        EXPECT_EQ(code_with(Traced{}, passes), 0);
        EXPECT_EQ(code_with(Skipped{Status::skipped, "no device"}, passes), 0);
        EXPECT_EQ(code_with(Skipped{Status::unsupported, "no AVX2"}, passes), 0);
    }
}

TEST(ExitCodes, a_flawed_row_fails_unless_it_may_pass)
{
    EXPECT_EQ(code_with(judged(2, 0, 0), false), 1);
    EXPECT_EQ(code_with(judged(2, 0, 0), true), 0);
}

TEST(ExitCodes, a_lost_ray_of_a_robust_method_or_one_that_differs_from_openmp_fails_always)
{
    for (const bool passes : {false, true}) {
        EXPECT_EQ(code_with(judged(0, 1, 0), passes), 1);
        EXPECT_EQ(code_with(judged(0, 0, 1), passes), 1);
    }
    EXPECT_EQ(status_of(row_with(judged(0, 0, 1))), Status::wrong);
    EXPECT_EQ(status_of(row_with(judged(3, 1, 0))), Status::flawed);
    EXPECT_EQ(reason_of(row_with(judged(3, 1, 0))), "1 lost, 3 wrong");
    EXPECT_EQ(reason_of(row_with(judged(0, 0, 2))), "2 different from openmp's");
}

TEST(ExitCodes, a_method_that_does_not_claim_robustness_fails_only_where_a_device_differs_from_openmp)
{
    for (const Method method : {Method::plane, Method::plucker, Method::stp, Method::ms06, Method::single})
        for (const bool passes : {false, true}) {
            EXPECT_FALSE(fails(row_with(judged(3, 1, 0), method), passes)) << name_of(method);
            EXPECT_TRUE(fails(row_with(judged(3, 1, 1), method), passes)) << name_of(method);
        }
    EXPECT_TRUE(claims_robustness({}));
    for (const Method method : {Method::maria, Method::project})
        EXPECT_FALSE(claims_robustness({.method = method, .math = MathMode::fast})) << "held to no proof";
    EXPECT_TRUE(claims_robustness({.method = Method::project}));
    EXPECT_TRUE(claims_robustness({.structure = Structure::bvh, .method = Method::single, .layout = Layout::cwbvh}));
    for (const Layout theirs : {Layout::embree, Layout::embree_medium, Layout::embree_robust, Layout::rt})
        EXPECT_FALSE(claims_robustness({.structure = Structure::bvh, .method = Method::single, .layout = theirs}));
}

TEST(ExitCodes, an_error_gives_that_of_its_kind_unless_something_is_wrong)
{
    EXPECT_EQ(code_with(Failed{ErrorKind::internal, ""}, true), exit_code(ErrorKind::internal));
    EXPECT_EQ(code_with(Failed{ErrorKind::invalid_input, ""}, true), exit_code(ErrorKind::invalid_input));
    EXPECT_NE(code_with(Failed{ErrorKind::internal, ""}, true), 0);
    std::vector<RowRecord> rows;
    rows.push_back(row_with(Failed{ErrorKind::internal, ""}));
    rows.push_back(row_with(judged(0, 1, 0)));
    EXPECT_EQ(exit_code(rows, true), 1);
}
