#include "bench/reproduce/tables/tables.h"
#include "core/base/error.h"
#include "tests/reproduce/embree_rows.h"
#include "tests/reproduce/timed_runs.h"
#include "tests/support/temporary_folder.h"

#include <random>

using namespace tetrace;
using namespace tetrace::test;

namespace {

RowPair pair_of(const SceneRun& run, Layout cdt, Layout bvh, Method method = Method::single)
{
    for (RowPair& pair : row_pairs(run))
        if (run.rows[pair.cdt].key.kernel.layout == cdt && run.rows[pair.bvh].key.kernel.layout == bvh &&
            run.rows[pair.bvh].key.kernel.method == method)
            return pair;
    throw std::runtime_error("no such pair");
}

ClaimVerdict verdict_of(const SceneRun& run, const std::string& id)
{
    return claim_of(table6_pairs({&run}), id).verdict;
}

const PaperCell& cell_of(const PaperTable& table, std::size_t row, const std::string& key)
{
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].key == key) return table.rows.at(row).at(c);
    throw std::runtime_error("no column " + key);
}

double value_of(const PaperTable& table, std::size_t row, const std::string& key)
{
    return std::get<Quantity>(cell_of(table, row, key)).ours.value;
}

std::string text_of(const PaperTable& table, std::size_t row, const std::string& key)
{
    return std::get<std::string>(cell_of(table, row, key));
}

} // namespace

TEST(Table6, a_ratio_is_of_one_view_and_not_of_two)
{
    const PairedRatio same = paired_ratio(ramp(1), ramp(2), Sampling::even);
    EXPECT_EQ(same.median.value, 2);
    EXPECT_EQ(same.median.low, 2) << "other pairs than those of one view spread";
    EXPECT_EQ(same.median.high, 2);
    EXPECT_EQ(same.won, 1);
    auto reversed = ramp(2);
    std::reverse(reversed.begin(), reversed.end());
    const PairedRatio other = paired_ratio(ramp(1), reversed, Sampling::even);
    EXPECT_EQ(other.median.value, 2) << "2 * 7 / 7, the middle view";
    EXPECT_EQ(other.lowest, 2.0 / 13);
    EXPECT_EQ(other.highest, 26);
    EXPECT_EQ(other.won, 9.0 / 13) << "2 (13 - i) > i + 1 up to i = 8";
    EXPECT_EQ(other.median.low, 2.0 * 3 / 11) << "the third of thirteen";
    EXPECT_EQ(other.median.high, 2.0 * 11 / 3);
}

TEST(Table6, equal_times_are_nobodys_view)
{
    const PairedRatio pair = paired_ratio(ramp(1), ramp(1), Sampling::even);
    EXPECT_EQ(pair.won, 0);
    EXPECT_EQ(pair.median.value, 1);
}

TEST(Table6, times_that_do_not_pair_are_refused)
{
    EXPECT_THROW(static_cast<void>(paired_ratio({1, 2}, {1}, Sampling::even)), Error);
    EXPECT_THROW(static_cast<void>(paired_ratio({}, {}, Sampling::even)), Error);
    EXPECT_THROW(static_cast<void>(paired_ratio({1}, {0}, Sampling::even)), Error);
    EXPECT_THROW(static_cast<void>(paired_ratio({std::nan("")}, {1}, Sampling::even)), Error);
}

TEST(Table6, too_few_views_or_chosen_ones_bound_no_median)
{
    EXPECT_FALSE(median_of_views(std::vector<double>(min_views - 1, 2)).low);
    EXPECT_TRUE(median_of_views(std::vector<double>(min_views, 2)).low);
    EXPECT_FALSE(median_of_views(ramp(1), Sampling::chosen).low);
    EXPECT_THROW(static_cast<void>(median_of_views({})), Error);
}

TEST(Table6, the_medians_interval_holds_the_median_in_19_of_20_samples)
{
    std::mt19937_64 random(20261122);
    for (const std::size_t size : {10u, 13u, 65u, 1282u}) {
        const int trials = size > 1000 ? 300 : 2000;
        int missed = 0;
        for (int trial = 0; trial < trials; ++trial) {
            std::vector<double> values(size); // skewed, its median is 1
            for (double& value : values)
                value = std::exp2(8 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5));
            const Estimate median = median_of_views(values);
            missed += *median.low > 1 || *median.high < 1 ? 1 : 0;
        }
        // At most 0.05, and 4 standard deviations of the trials; at 10 views no interval has more than 0.02.
        EXPECT_LE(missed, trials * 0.05 + 4 * std::sqrt(trials * 0.05 * 0.95)) << size << " views";
        if (size < 65) continue;
        EXPECT_GE(missed, trials * 0.03 - 4 * std::sqrt(trials * 0.03 * 0.97)) << "needlessly wide";
    }
}

TEST(Table6, a_slower_build_is_paid_by_faster_rays_or_never)
{
    using Ahead = BreakEven::Ahead;
    const BreakEven paid = break_even({11, 1e-6}, {1, 2e-6});
    EXPECT_EQ(paid.ahead, Ahead::first);
    EXPECT_NEAR(paid.rays.value(), 1e7, 1e-3);
    const BreakEven swapped = break_even({1, 2e-6}, {11, 1e-6});
    EXPECT_EQ(swapped.ahead, Ahead::second);
    EXPECT_NEAR(swapped.rays.value(), 1e7, 1e-3);
    const BreakEven always = break_even({1, 1e-6}, {11, 2e-6});
    EXPECT_EQ(always.ahead, Ahead::first);
    EXPECT_FALSE(always.rays);
    EXPECT_EQ(break_even({2, 1e-6}, {1, 1e-6}).ahead, Ahead::second) << "of equal rays the build decides";
    EXPECT_FALSE(break_even({2, 1e-6}, {1, 1e-6}).rays);
    EXPECT_EQ(break_even({1, 1e-6}, {1, 1e-6}).ahead, Ahead::neither);
}

TEST(Table6, rows_pair_on_one_device_and_embree_with_openmp)
{
    const SceneRun run = open_run("openmp,cuda-host,embree");
    EXPECT_EQ(run.rows.size(), 10 + embree_rows()) << "two of maria, bvh2, bvh4 and cwbvh on two devices, and Embree's";
    std::size_t with_embree = 0;
    for (const RowPair& pair : row_pairs(run)) {
        const RowRun &cdt = run.rows[pair.cdt], &bvh = run.rows[pair.bvh];
        EXPECT_EQ(cdt.key.kernel.method, Method::maria);
        EXPECT_EQ(bvh.key.kernel.structure, Structure::bvh);
        const bool is_embree = bvh.key.backend == "embree";
        with_embree += is_embree ? 1 : 0;
        EXPECT_EQ(cdt.key.backend, is_embree ? "openmp" : bvh.key.backend);
    }
    EXPECT_EQ(with_embree, 2 * traced_embree_rows());
    EXPECT_EQ(row_pairs(run).size(), 2 * (6 + traced_embree_rows()));
    EXPECT_EQ(fastest_pairs(run).size(), 6 + traced_embree_rows()) << "one layout of the CDT a device";
}

TEST(Table6, tets_for_rays_are_compared_by_the_fastest_walk_as_well_the_cdt_only_by_marias)
{
    SceneRun run = open_run("openmp");
    const auto has_project = [&] {
        return std::ranges::any_of(row_pairs(run), [&](const RowPair& pair) {
            return run.rows[pair.cdt].key.kernel.method == Method::project;
        });
    };
    run.rows[find_row(run, Layout::tet96, Method::maria)].key.kernel.method = Method::project;
    set_all(run, 2, 3);
    EXPECT_FALSE(has_project()) << "the paper's claims are about its own method";
    run.build.build = rays_build;
    EXPECT_TRUE(has_project());
    set_times(run, find_row(run, Layout::tet96, Method::project), ramp(1.5));
    for (const RowPair& pair : fastest_pairs(run))
        EXPECT_EQ(run.rows[pair.cdt].key.kernel.method, Method::project);
}

TEST(Table6, rows_of_different_math_modes_are_not_compared)
{
    SceneRun run = open_run("openmp");
    set_all(run, 1, 2);
    const std::size_t bvh2 = find_row(run, Layout::bvh2, Method::single);
    ASSERT_FALSE(row_pairs(run).empty());
    run.rows[bvh2].key.kernel.math = MathMode::fast;
    for (const RowPair& pair : row_pairs(run))
        EXPECT_NE(pair.bvh, bvh2) << "an exact row of the CDT and a fast one of the BVH";
    for (RowRun& row : run.rows)
        if (is_cdt(row) && row.key.kernel.layout != Layout::tet80) row.key.kernel.math = MathMode::fast;
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        if (is_cdt(run.rows[i])) set_times(run, i, ramp(run.rows[i].key.kernel.math == MathMode::fast ? 0.5 : 1));
    bool has_exact = false;
    for (const RowPair& pair : fastest_pairs(run))
        has_exact = has_exact || run.rows[pair.cdt].key.kernel.layout == Layout::tet80;
    EXPECT_TRUE(has_exact) << "a fast row does not count as a faster layout than an exact one's";
}

TEST(Table6, the_fastest_layout_represents_the_cdt)
{
    SceneRun run = open_run();
    set_all(run, 2, 3);
    set_times(run, find_row(run, Layout::tet96, Method::maria), ramp(1.5));
    for (const RowPair& pair : fastest_pairs(run)) {
        EXPECT_EQ(run.rows[pair.cdt].key.kernel.layout, Layout::tet96);
        EXPECT_DOUBLE_EQ(pair.ratio.median.value, 2);
    }
    EXPECT_DOUBLE_EQ(pair_of(run, Layout::tet80, Layout::bvh2).ratio.median.value, 1.5);
}

TEST(Table6, the_table_has_frames_of_the_papers_size_build_times_and_memory)
{
    SceneRun run = open_run();
    set_all(run, pixels / papers_pixels, pixels / papers_pixels / 4); // the CDT takes a second a frame in view 0
    const std::size_t cdt = find_row(run, Layout::tet80, Method::maria);
    set_setup_cost(run.rows[cdt], SetupCost{12, 0.5, 3'000'000});
    const PaperTable table = table6({&run});
    ASSERT_EQ(table.rows.size(), run.rows.size());
    EXPECT_NEAR(value_of(table, cdt, "most_frames_per_s"), 1, 1e-12);
    EXPECT_NEAR(value_of(table, cdt, "least_frames_per_s"), 1.0 / 13, 1e-12);
    EXPECT_NEAR(value_of(table, cdt, "frames_per_s"), 1.0 / 7, 1e-12);
    const std::size_t bvh = find_row(run, Layout::bvh2, Method::single);
    EXPECT_NEAR(value_of(table, bvh, "most_frames_per_s"), 4, 1e-12);
    EXPECT_EQ(value_of(table, cdt, "build_s"), 12);
    EXPECT_EQ(value_of(table, cdt, "pack_s"), 0.5);
    EXPECT_EQ(value_of(table, cdt, "memory_mb"), 3);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(cell_of(table, bvh, "build_s"))) << "not known";
    EXPECT_EQ(text_of(table, cdt, "papers_frames_per_s"), "not its scene");
}

TEST(Table6, the_papers_frames_are_next_to_only_a_gpu)
{
    SceneRun run = open_run();
    run.build.scene = "armadillo";
    const std::size_t cdt = find_row(run, Layout::tet80, Method::maria),
                      bvh = find_row(run, Layout::bvh2, Method::single);
    const auto papers = [&](std::size_t row) {
        return std::get<Quantity>(cell_of(table6({&run}), row, "most_frames_per_s")).paper;
    };
    EXPECT_FALSE(papers(cdt));
    EXPECT_EQ(text_of(table6({&run}), cdt, "papers_frames_per_s"), "82 to 160, a GPU");
    EXPECT_EQ(text_of(table6({&run}), find_row(run, Layout::cwbvh, Method::single), "papers_frames_per_s"),
              "not its BVH");
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::gpu;
    EXPECT_EQ(papers(cdt), 160);
    EXPECT_EQ(papers(bvh), 260);
    run.build.scene = "bunny";
    EXPECT_EQ(papers(cdt), 1040);
    run.build.scene = "cubes";
    EXPECT_FALSE(papers(cdt));
}

TEST(Table6, a_pair_reports_after_how_many_rays_its_builds_are_paid)
{
    SceneRun run = open_run();
    set_all(run, 1e-6 * pixels, 2e-6 * pixels); // 7 times that a view on average: 7 and 14 us per ray
    const std::size_t cdt = find_row(run, Layout::tet80, Method::maria),
                      bvh = find_row(run, Layout::bvh2, Method::single);
    set_setup_cost(run.rows[cdt], SetupCost{69, 2, 1});
    set_setup_cost(run.rows[bvh], SetupCost{0.5, 0.5, 1});
    EXPECT_NEAR(break_even(pair_of(run, Layout::tet80, Layout::bvh2))->rays.value(), 1e7, 1);
    EXPECT_FALSE(break_even(pair_of(run, Layout::tet80, Layout::cwbvh))) << "its build time is not known";
    const PaperTable table = table6_pairs({&run});
    EXPECT_EQ(text_of(table, 0, "rival"), "single bvh2");
    EXPECT_NEAR(value_of(table, 0, "break_even_mrays"), 10, 1e-6);
    EXPECT_EQ(text_of(table, 0, "ahead"), "the CDT, from there on");
    EXPECT_EQ(value_of(table, 0, "won_percent"), 100);
    set_setup_cost(run.rows[cdt], SetupCost{0.5, 0.5, 1});
    EXPECT_EQ(text_of(table6_pairs({&run}), 0, "break_even_mrays"), "never");
    EXPECT_EQ(text_of(table6_pairs({&run}), 0, "ahead"), "the CDT, always");
    set_times(run, bvh, ramp(0.5e-6 * pixels));
    EXPECT_EQ(text_of(table6_pairs({&run}), 0, "ahead"), "the BVH, always");
}

TEST(Table6, rates_that_cannot_be_distinguished_pay_nothing)
{
    SceneRun run = open_run();
    set_all(run, 1, 1);
    auto mixed = ramp(1);
    for (std::size_t view = 0; view < views; ++view)
        mixed[view] *= view % 2 == 0 ? 1.2 : 0.8;
    set_times(run, find_row(run, Layout::bvh2, Method::single), mixed);
    for (RowRun& row : run.rows)
        set_setup_cost(row, {1, 1, 1});
    EXPECT_FALSE(break_even(pair_of(run, Layout::tet80, Layout::bvh2)));
    EXPECT_EQ(text_of(table6_pairs({&run}), 0, "ahead"), "undecided");
}

TEST(Table6, claims_are_decided_by_the_interval_on_the_kind_of_device_that_they_name)
{
    SceneRun run = open_run();
    set_all(run, 1, 2);
    be_like(run, "bunny", LikenessKind::papers_counts);
    EXPECT_EQ(verdict_of(run, "table6-cdt-is-faster-on-bunny-cpu"), ClaimVerdict::holds);
    EXPECT_EQ(verdict_of(run, "table6-cdt-is-faster-on-bunny-gpu"), ClaimVerdict::not_testable);
    EXPECT_EQ(verdict_of(run, "table6-cdt-is-faster-on-banana-cpu"), ClaimVerdict::not_testable);
    EXPECT_TRUE(contains(claim_of(table6_pairs({&run}), "table6-cdt-is-faster-on-bunny-cpu").text,
                         "on this CPU (the paper's claim is of a GPU)"));
    be_like(run, "armadillo", LikenessKind::near_counts);
    EXPECT_EQ(verdict_of(run, "table6-bvh-is-faster-on-armadillo-cpu"), ClaimVerdict::does_not_hold);
    set_all(run, 2, 1);
    EXPECT_EQ(verdict_of(run, "table6-bvh-is-faster-on-armadillo-cpu"), ClaimVerdict::holds);
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::gpu;
    EXPECT_EQ(verdict_of(run, "table6-bvh-is-faster-on-armadillo-gpu"), ClaimVerdict::holds);
    EXPECT_EQ(verdict_of(run, "table6-bvh-is-faster-on-armadillo-cpu"), ClaimVerdict::not_testable);
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::emulated;
    EXPECT_EQ(verdict_of(run, "table6-bvh-is-faster-on-armadillo-gpu"), ClaimVerdict::not_testable);
}

TEST(Table6, claims_need_an_interval_and_quiet_rows_and_use_only_bvh2)
{
    SceneRun run = open_run();
    set_all(run, 1, 2);
    be_like(run, "bunny", LikenessKind::papers_counts);
    const std::string id = "table6-cdt-is-faster-on-bunny-cpu";
    set_times(run, find_row(run, Layout::cwbvh, Method::single), ramp(0.1));
    set_times(run, find_row(run, Layout::embree, Method::single, "embree"), ramp(0.1));
    EXPECT_EQ(verdict_of(run, id), ClaimVerdict::holds) << "the paper lacks such a BVH";
    set_times(run, find_row(run, Layout::tet80, Method::maria), ramp(9));
    EXPECT_EQ(verdict_of(run, id), ClaimVerdict::holds) << "tet96 is the faster layout";
    run.sampling = Sampling::chosen;
    EXPECT_EQ(verdict_of(run, id), ClaimVerdict::not_testable) << "these views say nothing of the others";
    run.sampling = Sampling::even;
    auto reversed = ramp(1);
    std::reverse(reversed.begin(), reversed.end());
    set_times(run, find_row(run, Layout::bvh2, Method::single), reversed);
    EXPECT_EQ(verdict_of(run, id), ClaimVerdict::not_testable) << "its interval holds 1";
    set_times(run, find_row(run, Layout::bvh2, Method::single), ramp(2));
    run.rows[find_row(run, Layout::bvh2, Method::single)].samples_s[0] *= 1.5;
    EXPECT_EQ(verdict_of(run, id), ClaimVerdict::not_testable) << "noisy";
}

TEST(Table6, a_row_without_a_rate_is_reported_and_pairs_with_nothing)
{
    SceneRun run = open_run();
    run.rows[find_row(run, Layout::bvh2, Method::single)].outcome = Skipped{Status::skipped, "no such thing"};
    EXPECT_EQ(row_pairs(run).size(), 2 * (2 + traced_embree_rows()));
    EXPECT_EQ(text_of(table6({&run}), find_row(run, Layout::bvh2, Method::single), "status"), "skipped: no such thing");
}

TEST(Table6, a_curve_ascends_and_ends_with_all_views)
{
    SceneRun run = open_run();
    set_all(run, 1, 2);
    auto reversed = ramp(2);
    std::reverse(reversed.begin(), reversed.end());
    set_times(run, find_row(run, Layout::bvh2, Method::single), reversed);
    const auto figures = table6_figures({&run});
    ASSERT_EQ(figures.size(), 1u);
    EXPECT_EQ(figures[0].id, "table6-cubes-cpu");
    ASSERT_EQ(figures[0].series.size(), 4 + traced_embree_rows())
        << "bvh2, bvh4, cwbvh, Embree's, and the line of equal times";
    const auto& points = figures[0].series[0].points;
    ASSERT_EQ(points.size(), views);
    EXPECT_TRUE(std::is_sorted(points.begin(), points.end()));
    EXPECT_EQ(points.front().second, 2.0 / 13);
    EXPECT_EQ(points.back(), std::pair(100.0, 26.0));
    EXPECT_EQ(figures[0].series[0].name, "bvh2");
    EXPECT_EQ(figures[0].series[3].name, "Embree single");
}
