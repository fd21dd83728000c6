// The paper's claims about scenes and pairs, on rows whose times are the test's.
#include "bench/reproduce/speed.h"
#include "tests/reproduce/timed_runs.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>

using namespace tetrace;
using namespace tetrace::test;

namespace {

ClaimVerdict verdict_of(const SceneRuns& runs, const std::string& id)
{
    return claim_of(table6_pairs(runs), id).verdict;
}

/// View times that range from 1 to most, times the factor.
std::vector<double> range_to(double most, double factor)
{
    std::vector<double> seconds;
    for (std::size_t view = 0; view < views; ++view)
        seconds.push_back(factor * (1 + (most - 1) * static_cast<double>(view) / (views - 1)));
    return seconds;
}

void set_ranges(SceneRun& run, double cdt, double bvh)
{
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        set_times(run, i, range_to(is_cdt(run.rows[i]) ? cdt : bvh, 1e-3));
}

/// A rate in each view; the run's mean rate is that.
void set_rate(SceneRun& run, double mrays)
{
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        set_times(run, i, std::vector<double>(views, 1e-6 * pixels / mrays));
}

SceneRun run_of(const std::string& scene, LikenessKind kind = LikenessKind::papers_counts,
                const std::string& backends = "openmp")
{
    SceneRun run = open_run(backends);
    be_like(run, scene, kind);
    return run;
}

} // namespace

TEST(PairClaims, the_papers_build_decides_if_there_is_one)
{
    SceneRun ours = run_of("bunny", LikenessKind::other_tets), papers = run_of("bunny");
    papers.build.build = papers_build;
    set_all(ours, 1, 2);
    set_all(papers, 2, 1);
    const std::string id = "table6-cdt-is-faster-on-bunny-cpu";
    EXPECT_EQ(verdict_of({&ours, &papers}, id), ClaimVerdict::does_not_hold);
    EXPECT_EQ(verdict_of({&papers, &ours}, id), ClaimVerdict::does_not_hold);
    EXPECT_EQ(verdict_of({&ours}, id), ClaimVerdict::holds) << "what the paper claims of its CDTs is meant of any";
}

TEST(PairClaims, tets_for_rays_decide_no_claim_of_the_paper)
{
    SceneRun ours = run_of("bunny"), rays = run_of("bunny", LikenessKind::tets_for_rays);
    rays.build.build = rays_build;
    set_all(ours, 2, 1);
    set_all(rays, 1, 9);
    const std::string id = "table6-cdt-is-faster-on-bunny-cpu";
    EXPECT_EQ(verdict_of({&ours, &rays}, id), ClaimVerdict::does_not_hold);
    EXPECT_EQ(verdict_of({&rays, &ours}, id), ClaimVerdict::does_not_hold);
    EXPECT_EQ(verdict_of({&rays}, id), ClaimVerdict::not_testable);
    const auto papers_claims = [](const SceneRuns& runs) {
        std::string text;
        for (const PaperTable& table :
             {table3(runs), table3_rates(runs), table4(runs, 1282), table6_pairs(runs), figure6_table(runs)})
            for (const Claim& claim : table.claims)
                if (!contains(claim.text, "not the paper's")) text += claim_json(claim).dump() + "\n";
        return text;
    };
    EXPECT_EQ(papers_claims({&ours, &rays}), papers_claims({&ours}));
    EXPECT_EQ(papers_claims({&rays, &ours}), papers_claims({&ours}));
    EXPECT_FALSE(contains(papers_claims({&rays}), R"("holds")")) << papers_claims({&rays});
}

TEST(PairClaims, tets_for_rays_have_a_claim_of_their_own_and_no_number_of_the_papers)
{
    SceneRun ours = run_of("bunny"), rays = run_of("bunny", LikenessKind::tets_for_rays);
    rays.build.build = rays_build;
    const std::string id = "table6-tets-for-rays-are-faster-on-bunny-cpu";
    EXPECT_THROW((void)verdict_of({&ours}, id), std::runtime_error);
    set_all(rays, 1, 2);
    EXPECT_EQ(verdict_of({&ours, &rays}, id), ClaimVerdict::holds);
    EXPECT_FALSE(contains(claim_of(table6_pairs({&rays}), id).evidence, "CDT")) << "they are none";
    set_times(rays, find_row(rays, Layout::cwbvh, Method::single), ramp(0.5));
    EXPECT_EQ(verdict_of({&rays}, id), ClaimVerdict::does_not_hold) << "each of our BVHs counts";
    set_all(rays, 1, 2);
    for (const PaperTable& table :
         {table3({&rays}), table3_rates({&rays}), table4({&rays}, 1282), table6({&rays}), figure6_table({&rays})})
        for (const auto& row : table.rows)
            for (const PaperCell& cell : row)
                if (const auto* number = std::get_if<Quantity>(&cell)) {
                    EXPECT_FALSE(number->paper) << table.id;
                }
    EXPECT_EQ(figure6({&rays})[0].series.size(), 2u) << "only maria on two layouts";
}

TEST(PairClaims, tets_for_rays_are_judged_by_the_fastest_bvh_of_the_device_which_the_verdict_names)
{
    SceneRun rays = run_of("bunny", LikenessKind::tets_for_rays, "openmp,embree");
    rays.build.build = rays_build;
    const std::string id = "table6-tets-for-rays-are-faster-on-bunny-cpu";
    set_all(rays, 1, 2);
    const std::size_t packets = find_row(rays, Layout::embree, Method::packet16, "embree");
    set_times(rays, packets, ramp(1.5));
    EXPECT_EQ(verdict_of({&rays}, id), ClaimVerdict::holds);
    EXPECT_TRUE(contains(claim_of(table6_pairs({&rays}), id).evidence,
                         "against the fastest BVH, bvh packet16 on embree: the BVH's time is 1.5 "))
        << claim_of(table6_pairs({&rays}), id).evidence;
    set_times(rays, packets, ramp(0.5));
    EXPECT_EQ(verdict_of({&rays}, id), ClaimVerdict::does_not_hold) << "faster than ours, and slower than Embree's";
    set_times(rays, packets, ramp(3));
    set_times(rays, find_row(rays, Layout::embree, Method::single, "embree"), ramp(0.75));
    EXPECT_EQ(verdict_of({&rays}, id), ClaimVerdict::does_not_hold);
    EXPECT_TRUE(contains(claim_of(table6_pairs({&rays}), id).evidence,
                         "the fastest BVH, bvh single on embree: the BVH's time is 0.75"));
}

TEST(PairClaims, a_claim_about_bvh2_says_which_bvh_is_faster)
{
    SceneRun run = run_of("bunny", LikenessKind::papers_counts, "openmp,embree");
    set_all(run, 1, 2);
    const auto evidence = [&] { return claim_of(table6_pairs({&run}), "table6-cdt-is-faster-on-bunny-cpu").evidence; };
    set_times(run, find_row(run, Layout::embree, Method::packet16, "embree"), ramp(0.5));
    EXPECT_TRUE(contains(evidence(), "against bvh bvh2 on openmp: the BVH's time is 2 ")) << evidence();
    EXPECT_TRUE(contains(evidence(), "The fastest BVH, bvh packet16 on embree, takes 0.5 ")) << evidence();
    EXPECT_EQ(verdict_of({&run}, "table6-cdt-is-faster-on-bunny-cpu"), ClaimVerdict::holds)
        << "the paper's claim is of its kind of BVH";
    set_times(run, find_row(run, Layout::bvh2, Method::single), ramp(0.25));
    EXPECT_TRUE(contains(evidence(), "against the fastest BVH, bvh bvh2 on openmp: the BVH's time is 0.25 "))
        << evidence();
    EXPECT_FALSE(contains(evidence(), "The fastest BVH")) << evidence();
}

TEST(PairClaims, another_mesh_decides_nothing_and_says_why)
{
    SceneRun run = run_of("armadillo", LikenessKind::other_mesh);
    set_all(run, 2, 1);
    const PaperTable table = table6_pairs({&run});
    const Claim& claim = claim_of(table, "table6-bvh-is-faster-on-armadillo-cpu");
    EXPECT_EQ(claim.verdict, ClaimVerdict::not_testable);
    EXPECT_TRUE(contains(claim.evidence, "another mesh"));
    EXPECT_TRUE(contains(claim.evidence, "frames/s")) << "our figures are still there";
}

TEST(PairClaims, the_larger_amplitude_is_found_without_the_extreme_views)
{
    SceneRun run = run_of("bunny");
    const std::string id = "table6-cdt-has-the-larger-amplitude-cpu";
    set_ranges(run, 8, 2);
    EXPECT_EQ(verdict_of({&run}, id), ClaimVerdict::holds);
    set_ranges(run, 2, 8);
    EXPECT_EQ(verdict_of({&run}, id), ClaimVerdict::does_not_hold);
    set_ranges(run, 2, 2);
    EXPECT_EQ(verdict_of({&run}, id), ClaimVerdict::not_testable);
    auto with_one_slow_view = range_to(2, 1e-3);
    with_one_slow_view.back() = 1;
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        if (is_cdt(run.rows[i])) set_times(run, i, with_one_slow_view);
    EXPECT_EQ(verdict_of({&run}, id), ClaimVerdict::not_testable) << "one view does not make an amplitude";
    set_ranges(run, 8, 2);
    run.sampling = Sampling::chosen;
    EXPECT_EQ(verdict_of({&run}, id), ClaimVerdict::not_testable);
    EXPECT_EQ(verdict_of({&run}, "table6-cdt-has-the-larger-amplitude-gpu"), ClaimVerdict::not_testable);
}

TEST(PairClaims, dependence_on_size_takes_two_scenes_that_are_like_the_papers)
{
    SceneRun banana = run_of("banana"), bunny = run_of("bunny");
    const std::string id = "table6-bvh-depends-less-on-size-cpu";
    set_all(banana, 1, 1);
    set_all(bunny, 5, 2);
    EXPECT_EQ(verdict_of({&banana, &bunny}, id), ClaimVerdict::holds);
    EXPECT_EQ(verdict_of({&bunny, &banana}, id), ClaimVerdict::holds) << "the order of the paper's scenes counts";
    set_all(bunny, 2, 5);
    EXPECT_EQ(verdict_of({&banana, &bunny}, id), ClaimVerdict::does_not_hold);
    EXPECT_EQ(verdict_of({&bunny}, id), ClaimVerdict::not_testable);
    be_like(bunny, "bunny", LikenessKind::other_mesh);
    EXPECT_EQ(verdict_of({&banana, &bunny}, id), ClaimVerdict::not_testable);
}

TEST(PairClaims, a_mean_rate_is_of_all_three_scenes_or_of_none)
{
    SceneRun banana = run_of("banana"), bunny = run_of("bunny"), armadillo = run_of("armadillo");
    const SceneRuns all = {&banana, &bunny, &armadillo};
    const auto verdict = [&] { return mean_rate_claim(all, paper::Place::cpu).verdict; };
    set_rate(banana, 20);
    set_rate(bunny, 8);
    set_rate(armadillo, 2);
    EXPECT_EQ(verdict(), ClaimVerdict::holds) << "their mean is 10";
    EXPECT_TRUE(contains(mean_rate_claim(all, paper::Place::cpu).evidence, "Their mean is 10"));
    set_rate(banana, 14);
    EXPECT_EQ(verdict(), ClaimVerdict::does_not_hold) << "it is 8";
    set_rate(banana, 20);
    be_like(armadillo, "armadillo", LikenessKind::other_mesh);
    const Claim without = mean_rate_claim(all, paper::Place::cpu);
    EXPECT_EQ(without.verdict, ClaimVerdict::not_testable);
    EXPECT_TRUE(contains(without.evidence, "Not all three scenes: armadillo is another mesh."));
    EXPECT_TRUE(contains(without.evidence, "armadillo 2 Mrays/s, the paper's 6.75"));
    EXPECT_EQ(mean_rate_claim(all, paper::Place::gpu).verdict, ClaimVerdict::not_testable) << "no GPU";
}

TEST(PairClaims, rates_are_next_to_the_papers_on_its_kinds_of_devices_with_a_ratio_for_its_mesh)
{
    SceneRun run = run_of("bunny");
    set_rate(run, 21);
    const auto cell = [&](Method method) {
        const PaperTable table = table3_rates({&run});
        for (std::size_t r = 0; r < table.rows.size(); ++r)
            for (std::size_t c = 0; c < table.columns.size(); ++c)
                if (table.columns[c].key == "mrays_per_s" && std::get<std::string>(table.rows[r][2]) == name_of(method))
                    return std::get<Quantity>(table.rows[r][c]);
        throw std::runtime_error("no such row");
    };
    EXPECT_EQ(cell(Method::maria).paper, 10.5);
    EXPECT_NEAR(cell(Method::maria).ratio().value(), 2, 1e-9);
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::gpu;
    EXPECT_EQ(cell(Method::maria).paper, 289);
    be_like(run, "armadillo", LikenessKind::other_mesh);
    EXPECT_EQ(cell(Method::maria).paper, 123);
    EXPECT_FALSE(cell(Method::maria).ratio());
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::emulated;
    EXPECT_FALSE(cell(Method::maria).paper);
}

TEST(PairClaims, figure6_has_the_papers_two_views_next_to_bunny_only_on_a_cpu)
{
    SceneRun run = run_of("bunny");
    const double papers_images = papers_pixels / pixels;
    set_times(run, find_row(run, Layout::tet80, Method::maria), std::vector<double>(views, 0.0802 / papers_images));
    const auto cell = [&](const std::string& key) {
        const PaperTable table = figure6_table({&run});
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            if (table.columns[c].key == key) return std::get<Quantity>(table.rows.at(0).at(c));
        throw std::runtime_error("no column " + key);
    };
    EXPECT_EQ(cell("fewest_mtets").paper, 9.6);
    EXPECT_EQ(cell("most_mtets").paper, 22.71);
    EXPECT_NEAR(cell("fewest_mtets").ours.value, 1e-6 * papers_pixels * cell("fewest_tets").ours.value, 1e-9);
    EXPECT_NEAR(cell("shortest_ms").ratio().value(), 2, 1e-9) << "80.2 ms per image of its size";
    EXPECT_EQ(cell("longest_ms").paper, 122);
    EXPECT_EQ(figure6({&run})[0].series.back().name, "the paper's views A and B, on its Core i7-4930K, 6 cores");
    be_like(run, "bunny", LikenessKind::other_mesh);
    EXPECT_FALSE(cell("fewest_mtets").ratio());
    EXPECT_EQ(figure6({&run})[0].series.size(), 2u) << "only maria on two layouts";
    be_like(run, "banana", LikenessKind::papers_counts);
    EXPECT_FALSE(cell("fewest_mtets").paper) << "its figure is of bunny";
    be_like(run, "bunny", LikenessKind::papers_counts);
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::gpu;
    EXPECT_TRUE(cell("fewest_mtets").paper);
    EXPECT_FALSE(cell("shortest_ms").paper) << "its times are of its CPU";
}

TEST(PairClaims, linear_time_need_not_be_proportional_and_a_tet_that_takes_longer_is_reported)
{
    SceneRun run = run_of("bunny");
    const std::size_t row = find_row(run, Layout::tet80, Method::maria);
    run.rows.resize(row + 1);
    run.images.resize(row + 1);
    const auto steps = view_steps(run, row);
    const auto verdict = [&](const auto& claim_of_rows) { return claim_of_rows({&run}, DeviceKind::cpu).verdict; };
    const auto set = [&](double factor, double offset, double power) {
        std::vector<double> seconds;
        for (std::size_t view = 0; view < steps.size(); ++view)
            seconds.push_back(factor * std::pow(steps[view], power) + offset);
        set_times(run, row, seconds);
    };
    for (std::size_t other = 0; other < row; ++other)
        run.rows[other].outcome = Skipped{Status::skipped, "not asked for"};
    set(1e-3, 0, 1);
    EXPECT_EQ(verdict(linear_claim), ClaimVerdict::holds);
    EXPECT_EQ(verdict(proportional_claim), ClaimVerdict::holds);
    set(1e-3, 1, 1);
    EXPECT_EQ(verdict(linear_claim), ClaimVerdict::holds);
    EXPECT_EQ(verdict(proportional_claim), ClaimVerdict::does_not_hold) << "most of it is there at 0 tets";
    EXPECT_EQ(verdict(slower_tets_claim), ClaimVerdict::does_not_hold) << "a tet takes less where there are more";
    set(1e-3, 0, 2);
    EXPECT_EQ(verdict(slower_tets_claim), ClaimVerdict::holds);
    EXPECT_EQ(linear_claim({&run}, DeviceKind::gpu).verdict, ClaimVerdict::not_testable);
}
