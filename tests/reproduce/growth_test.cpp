#include "bench/options/options.h"
#include "bench/reproduce/tables/tables.h"
#include "bench/statistics/power_law.h"
#include "core/base/error.h"
#include "tests/reproduce/embree_rows.h"
#include "tests/reproduce/timed_runs.h"
#include "tests/support/temporary_folder.h"

#include <list>
#include <random>
#include <tuple>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Rows of a size, and those with a line in a figure: maria in two layouts, bvh2, bvh4, cwbvh, and Embree's.
const std::size_t all_rows = 5 + embree_rows(), all_lines = 5 + traced_embree_rows();

const std::vector<double> sizes = {1500, 6000, 25000, 100000, 400000};

std::vector<double> powers(const std::vector<double>& x, double factor, double exponent)
{
    std::vector<double> y;
    for (const double value : x)
        y.push_back(factor * std::pow(value, exponent));
    return y;
}

/// Cubes in three sizes on the host; runs stay where they are.
struct Sizes {
    std::list<SceneRun> runs;

    explicit Sizes(const std::string& build = our_build)
    {
        const Options options =
            parse_options({"reproduce", "growth", "--scene", "cubes", "--size", "8", "--views", "0-1281:320",
                           "--backend", "openmp,embree", "--samples", "3", "--threads", "1"});
        for (SceneBuild size : growth_builds(scene_requests(options).front(), {3, 6, 12}, build)) {
            size.rivals = build == our_build;
            SceneRun& run = runs.emplace_back(open_scene_run(size, options));
            RunProgress progress;
            run_views(run, options, nullptr, progress);
            run.costs.resize(run.rows.size());
        }
    }

    [[nodiscard]] SceneRuns all() const
    {
        SceneRuns list;
        for (const SceneRun& run : runs)
            list.push_back(&run);
        return list;
    }

    [[nodiscard]] static double faces(const SceneRun& run)
    {
        return static_cast<double>(run.scene->counts().occlusive_faces);
    }

    /// Rays of a row take the factor times a power of the number of faces, in seconds.
    void set_times(std::size_t row, double factor, double exponent)
    {
        for (SceneRun& run : runs) {
            const auto rays = static_cast<double>(traced(run.rows[row])->totals.rays);
            run.rows[row].samples_s.assign(3, rays * factor * std::pow(faces(run), exponent));
        }
    }

    /// A ray of a row visits as many tets or nodes as that power of the number of faces, nearly.
    void set_visits(std::size_t row, double exponent)
    {
        for (SceneRun& run : runs) {
            auto& result = std::get<Traced>(run.rows[row].outcome);
            const auto visits = static_cast<std::uint64_t>(1e6 * std::pow(faces(run), exponent));
            result.totals = {.rays = 1000, .hit_steps = visits};
            if (!is_cdt(run.rows[row])) result.visits = {1000, visits, visits};
        }
    }
};

const Quantity& number(const PaperTable& table, std::size_t row, const std::string& key)
{
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].key == key) return std::get<Quantity>(table.rows.at(row).at(c));
    throw std::runtime_error("no column " + key);
}

bool is_empty(const PaperTable& table, std::size_t row, const std::string& key)
{
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].key == key) return std::holds_alternative<std::monostate>(table.rows.at(row).at(c));
    throw std::runtime_error("no column " + key);
}

} // namespace

TEST(PowerLaw, is_found_again_without_an_interval_where_all_points_are_on_it)
{
    for (const double exponent : {-0.5, 0.0, 1.0 / 3, 1.5}) {
        const auto law = fit_power_law(sizes, powers(sizes, 3, exponent));
        ASSERT_TRUE(law);
        EXPECT_NEAR(law->exponent.value, exponent, 1e-12);
        EXPECT_NEAR(law->factor, 3, 1e-9);
        EXPECT_NEAR(law->exponent.low.value(), exponent, 1e-6);
        EXPECT_NEAR(law->exponent.high.value(), exponent, 1e-6);
    }
}

TEST(PowerLaw, has_the_interval_of_a_textbooks_regression)
{
    // log2 y of log2 x = 0, 1, 2: 0, 1, 1. Slope 1/2, residuals -1/6, 1/3, -1/6: standard error sqrt(1/6 / 2).
    const auto law = fit_power_law({1, 2, 4}, {1, 2, 2});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent.value, 0.5, 1e-12);
    EXPECT_NEAR(law->exponent.high.value() - 0.5, 12.7062 * std::sqrt(1.0 / 12), 1e-9);
    EXPECT_NEAR(0.5 - law->exponent.low.value(), 12.7062 * std::sqrt(1.0 / 12), 1e-9);
}

TEST(PowerLaw, its_interval_holds_the_exponent_in_19_of_20_noisy_fits)
{
    std::mt19937_64 random(20261123);
    constexpr int trials = 4000;
    int missed = 0;
    for (int trial = 0; trial < trials; ++trial) {
        auto y = powers(sizes, 2, 0.4);
        for (double& value : y) {
            double normal = -6; // the sum of twelve uniform numbers
            for (int i = 0; i < 12; ++i)
                normal += static_cast<double>(random() >> 11) * 0x1p-53;
            value *= std::exp(0.1 * normal);
        }
        const auto law = fit_power_law(sizes, y);
        missed += *law->exponent.low > 0.4 || *law->exponent.high < 0.4 ? 1 : 0;
    }
    EXPECT_NEAR(missed, trials * 0.05, 4 * std::sqrt(trials * 0.05 * 0.95));
}

TEST(PowerLaw, needs_three_points_that_have_logarithms)
{
    EXPECT_FALSE(fit_power_law({1, 2}, {1, 2}));
    EXPECT_FALSE(fit_power_law({1, 2, 3}, {1, 0, 3}));
    EXPECT_FALSE(fit_power_law({1, -2, 3}, {1, 2, 3}));
    EXPECT_FALSE(fit_power_law({2, 2, 2}, {1, 2, 3})) << "one size";
    EXPECT_THROW(static_cast<void>(fit_power_law({1, 2, 3}, {1, 2})), Error);
}

TEST(Growth, sizes_are_builds_of_their_own_ascending_and_once)
{
    const auto banana = growth_builds({"banana", {}}, {6000, 1500, 6000});
    ASSERT_EQ(banana.size(), 2u);
    EXPECT_EQ(banana[0].request.name, "banana@1500");
    EXPECT_EQ(banana[1].label, "banana@6000");
    const auto cubes = growth_builds({"cubes", {}}, {4, 8});
    EXPECT_EQ(cubes[1].request.name, "cubes");
    EXPECT_EQ(cubes[1].request.build.resolution, 8u);
    EXPECT_EQ(cubes[1].label, "cubes@8");
    EXPECT_GE(growth_sizes().size(), 5u);
    const auto rays = growth_builds({"banana", {}}, {1500}, rays_build);
    EXPECT_EQ(rays[0].scene, "banana@1500");
    EXPECT_EQ(rays[0].label, "banana@1500-rays");
}

TEST(Growth, each_row_has_the_exponent_of_its_own_times)
{
    Sizes all;
    const std::size_t rows = all.runs.front().rows.size();
    ASSERT_EQ(rows, all_rows);
    for (std::size_t row = 0; row < rows; ++row)
        all.set_times(row, 1e-8 * static_cast<double>(row + 1), 0.1 * static_cast<double>(row));
    const PaperTable table = growth_exponents(all.all());
    ASSERT_EQ(table.rows.size(), rows);
    for (std::size_t row = 0; row < rows; ++row) {
        const Estimate& exponent = number(table, row, "time").ours;
        EXPECT_NEAR(exponent.value, 0.1 * static_cast<double>(row), 1e-9) << row;
        EXPECT_NEAR(*exponent.high - *exponent.low, 0, 1e-6) << "times of two rows are mixed";
        EXPECT_EQ(number(table, row, "sizes").ours.value, 3);
    }
}

TEST(Growth, the_table_has_what_rays_visit_of_the_structures_that_have_it)
{
    Sizes all;
    all.set_times(0, 2e-8, 0);
    all.runs.front().costs[0] = SetupCost{3, 0.5, 7'000'000};
    const PaperTable table = growth_table(all.all());
    ASSERT_EQ(table.rows.size(), 3 * all_rows);
    EXPECT_EQ(number(table, 0, "occlusive_faces").ours.value, Sizes::faces(all.runs.front()));
    EXPECT_NEAR(number(table, 0, "ns_a_ray").ours.value, 20, 1e-9);
    EXPECT_NEAR(number(table, 0, "mrays_per_s").ours.value, 50, 1e-9);
    EXPECT_EQ(number(table, 0, "build_s").ours.value, 3.5);
    EXPECT_EQ(number(table, 0, "memory_mb").ours.value, 7);
    const Traced& cdt = *traced(all.runs.front().rows[0]);
    EXPECT_EQ(number(table, 0, "steps").ours.value,
              static_cast<double>(cdt.totals.steps()) / static_cast<double>(cdt.totals.rays));
    EXPECT_TRUE(is_empty(table, 0, "nodes"));
    const Traced& bvh2 = *traced(all.runs.front().rows[2]);
    EXPECT_TRUE(is_empty(table, 2, "steps"));
    EXPECT_EQ(number(table, 2, "nodes").ours.value,
              static_cast<double>(bvh2.visits.nodes) / static_cast<double>(bvh2.visits.rays));
    EXPECT_TRUE(is_empty(table, 2, "build_s")) << "not known";
}

TEST(Growth, a_size_without_a_rate_has_no_part_in_the_fit)
{
    Sizes all;
    for (std::size_t row = 0; row < all_rows; ++row)
        all.set_times(row, 1e-8, 0.5);
    all.runs.back().rows[2].outcome = Failed{ErrorKind::internal, "lost"};
    const PaperTable exponents = growth_exponents(all.all());
    EXPECT_TRUE(is_empty(exponents, 2, "time")) << "two sizes are left";
    EXPECT_NEAR(number(exponents, 3, "time").ours.value, 0.5, 1e-9);
    EXPECT_TRUE(is_empty(growth_table(all.all()), 2 * all_rows + 2, "ns_a_ray"));
}

TEST(Growth, the_papers_claim_about_size_is_decided_by_the_exponents)
{
    Sizes all;
    const auto claim = [&] {
        for (const Claim& one : growth_exponents(all.all()).claims)
            if (one.id == "growth-bvh-depends-less-on-size-cpu") return one;
        throw std::runtime_error("no such claim");
    };
    for (std::size_t row = 0; row < all_rows; ++row)
        all.set_times(row, 1e-8, row < 2 ? 0.4 : 0.1); // the first two are the CDT
    EXPECT_EQ(claim().verdict, ClaimVerdict::holds) << claim().evidence;
    for (std::size_t row = 0; row < 2; ++row)
        all.set_times(row, 1e-8, 0.05);
    EXPECT_EQ(claim().verdict, ClaimVerdict::does_not_hold);
    all.runs.back().rows[2].outcome = Failed{ErrorKind::internal, "lost"};
    EXPECT_EQ(claim().verdict, ClaimVerdict::not_testable) << "bvh2 has two sizes";
}

TEST(Growth, tets_for_rays_are_lines_of_their_own_beside_the_same_bvhs)
{
    Sizes all, rays(rays_build);
    ASSERT_EQ(rays.runs.front().rows.size(), 4u) << "maria and project in two layouts each: the BVHs are the same";
    for (std::size_t row = 0; row < all_rows; ++row)
        all.set_times(row, 1e-8, row < 2 ? 0.4 : 0.1);
    for (std::size_t row = 0; row < 4; ++row)
        rays.set_times(row, 1e-8, 0);
    SceneRuns both = all.all();
    const SceneRuns of_rays = rays.all();
    both.insert(both.end(), of_rays.begin(), of_rays.end());
    const PaperTable table = growth_exponents(both);
    ASSERT_EQ(table.rows.size(), all_rows + 4);
    EXPECT_EQ(std::get<std::string>(table.rows[all_rows][1]), "rays");
    EXPECT_NEAR(number(table, all_rows, "time").ours.value, 0, 1e-9);
    EXPECT_NEAR(number(table, 0, "time").ours.value, 0.4, 1e-9);
    const auto verdict = [](const PaperTable& one, const std::string& id) { return claim_of(one, id).verdict; };
    EXPECT_EQ(verdict(table, "growth-bvh-depends-less-on-size-cpu"), ClaimVerdict::holds) << "it is about the CDT";
    const std::string ours = "growth-tets-for-rays-grow-less-than-nodes-cubes";
    for (const auto& [of_tets, of_nodes, expected] :
         {std::tuple(0.05, 0.1, ClaimVerdict::holds), std::tuple(0.2, 0.1, ClaimVerdict::does_not_hold)}) {
        rays.set_visits(0, of_tets);
        all.set_visits(2, of_nodes);
        const PaperTable now = growth_exponents(both);
        EXPECT_EQ(verdict(now, ours), expected) << claim_of(now, ours).evidence;
        EXPECT_TRUE(contains(claim_of(now, ours).evidence, "Tets: faces^"));
    }
    EXPECT_EQ(verdict(growth_exponents(of_rays), ours), ClaimVerdict::not_testable) << "no nodes";
    EXPECT_EQ(growth_exponents(all.all()).claims.size() + 1, table.claims.size());
    const auto figures = growth_figures(both);
    ASSERT_EQ(figures[0].series.size(), all_lines + 4);
    EXPECT_EQ(figures[0].series[all_lines].name, "tets for rays tet80 openmp");
    EXPECT_EQ(figures[0].series[all_lines + 2].name, "tets for rays half32 openmp");
    EXPECT_EQ(figures[0].series[all_lines + 3].name, "tets for rays tet64 openmp");
    ASSERT_EQ(figures[1].series.size(), 8u);
    EXPECT_EQ(figures[1].series[7].name, "tets for rays");
}

TEST(Growth, figures_are_lines_over_the_faces_with_logarithmic_axes)
{
    const Sizes all;
    const auto figures = growth_figures(all.all());
    ASSERT_EQ(figures.size(), 2u);
    EXPECT_EQ(figures[0].id, "growth-cubes-time-cpu");
    EXPECT_EQ(figures[0].series.size(), all_lines);
    EXPECT_TRUE(figures[0].x.logarithmic && figures[0].y.logarithmic);
    EXPECT_EQ(figure_json(figures[0])["y"]["scale"], "logarithmic");
    EXPECT_EQ(figures[1].id, "growth-cubes-visits");
    ASSERT_EQ(figures[1].series.size(), 7u);
    EXPECT_EQ(figures[1].series[0].name, "CDT, tets") << "both layouts have the same";
    EXPECT_EQ(figures[1].series[6].name, "cwbvh, triangles");
    for (const PaperFigure& figure : figures)
        for (const auto& series : figure.series) {
            ASSERT_EQ(series.points.size(), 3u);
            EXPECT_TRUE(std::is_sorted(series.points.begin(), series.points.end(),
                                       [](const auto& a, const auto& b) { return a.first < b.first; }));
        }
}
