#include "bench/output/score.h"
#include "bench/show/show_report.h"
#include "core/base/hash.h"
#include "scenes/pinned.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <regex>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Ten samples around that many seconds, 0.1 % apart, of a million rays.
RowRecord timed_row(const std::string& scene, RayKind rays, double seconds)
{
    RowRecord row;
    row.key = {scene, "openmp", {Structure::cdt, Method::project, Layout::half32}, rays};
    row.device.name = "a processor";
    Traced traced;
    traced.totals.rays = 1'000'000;
    row.outcome = traced;
    for (int i = 0; i < 10; ++i)
        row.samples_s.push_back(seconds * (1 + 0.001 * i));
    row.run_samples = {10};
    return row;
}

const Workload& scored()
{
    return workloads().at(1);
}

/// Nine rows of 1, 2, ... 9 seconds.
std::vector<RowRecord> rows_of_workload()
{
    std::vector<RowRecord> rows;
    for (std::size_t i = 0; i < scored().scenes.size(); ++i)
        for (const Workload::Rays& rays : scored().rays) {
            const std::string scene(find_pinned(scored().scenes[i])->of);
            rows.push_back(timed_row(scene, rays.kind, static_cast<double>(rows.size() + 1)));
            if (rays.kind == RayKind::primary) continue;
            rows.back().key.kernel.task = Task::rays;
            rows.back().ray_hash = rays.hashes.at(i);
        }
    return rows;
}

nlohmann::json scene_record(const std::string& name)
{
    const PinnedScene& pinned = *find_pinned(name);
    return {{"name", pinned.of},
            {"hash", hash_text(pinned.scene_hash)},
            {"camera_set_hash", hash_text(pinned.cameras_hash)},
            {"views", {0u, 1u}},
            {"width", 512u},
            {"height", 512u}};
}

std::vector<nlohmann::json> scenes_of_workload()
{
    std::vector<nlohmann::json> scenes;
    for (const std::string& name : scored().scenes)
        scenes.push_back(scene_record(name));
    return scenes;
}

} // namespace

TEST(Scores, are_geometric_means_with_an_interval_around_them)
{
    const auto rows = rows_of_workload();
    const auto scores = scores_of(&scored(), rows);
    ASSERT_EQ(scores.size(), 1u);
    const double factorial = std::tgamma(10.0);
    const double expected = 1 / (std::pow(factorial, 1.0 / 9) * 1.0045); // median of the samples
    EXPECT_EQ(scores[0].reason, "");
    EXPECT_NEAR(scores[0].mrays_per_s, expected, 1e-9);
    EXPECT_LT(scores[0].interval.low, expected);
    EXPECT_GT(scores[0].interval.high, expected);
    EXPECT_GT(scores[0].interval.low, expected / 1.0045) << "all medians at their greatest";
    EXPECT_LT(scores[0].interval.high, expected * 1.0045);
    EXPECT_EQ(scores_json(scores)[0]["rows"].size(), 9u);
    EXPECT_FALSE(scores_json(scores)[0].contains("threads"));
    auto with_one_thread = rows;
    for (RowRecord& row : with_one_thread)
        row.key.threads = 1;
    EXPECT_EQ(scores_json(scores_of(&scored(), with_one_thread))[0]["threads"], 1);
}

TEST(Scores, are_given_only_if_each_row_is_ok_and_not_noisy)
{
    const auto reason_with = [](const std::function<void(std::vector<RowRecord>&)>& change) {
        auto rows = rows_of_workload();
        change(rows);
        const auto scores = scores_of(&scored(), rows);
        EXPECT_FALSE(scores.at(0).is_score());
        EXPECT_EQ(scores_json(scores)[0].count("mrays_per_s"), 0u);
        return scores.at(0).reason;
    };
    EXPECT_EQ(reason_with([](auto& rows) { rows[4].disturbance = "calibration"; }), "1 of 9 rows are noisy");
    EXPECT_EQ(reason_with([](auto& rows) { rows[4].samples_s[0] = rows[4].samples_s[1] = rows[4].samples_s[2] = 1; }),
              "1 of 9 rows are noisy");
    EXPECT_EQ(reason_with([](auto& rows) { rows.pop_back(); }), "1 of 9 rows are missing");
    EXPECT_EQ(reason_with([](auto& rows) {
                  rows[0].outcome = Skipped{Status::skipped, "no time"};
              }),
              "bunny is skipped");
    EXPECT_EQ(reason_with([](auto& rows) { rows[0].outcome = Failed{}; }), "bunny is error");
    EXPECT_EQ(reason_with([](auto& rows) { std::get<Traced>(rows[1].outcome).verdicts.wrong = 1; }),
              "bunny, diffuse rays is flawed");
    const auto rows = rows_of_workload();
    EXPECT_EQ(scores_of(nullptr, rows).at(0).reason, "not a workload");
}

TEST(Scores, need_as_many_samples_and_runs_as_intervals_do)
{
    auto rows = rows_of_workload();
    rows[3].samples_s.resize(4);
    EXPECT_EQ(scores_of(&scored(), rows).at(0).reason, "fewer than 5 samples");
    rows = rows_of_workload();
    for (RowRecord& row : rows)
        row.run_samples = {5, 5};
    const Score two_runs = scores_of(&scored(), rows).at(0);
    EXPECT_TRUE(two_runs.is_score());
    EXPECT_NEAR(two_runs.interval.high, two_runs.mrays_per_s * 1.0045 / 1.002, 1e-9) << "the first run's";
    rows[2].run_samples = {10}; // interrupted in the second run
    EXPECT_EQ(scores_of(&scored(), rows).at(0).reason, "a run was interrupted");
}

TEST(Workloads, are_recognised_by_hashes_views_size_and_kinds_of_rays)
{
    const auto rows = rows_of_workload();
    EXPECT_EQ(workload_of(scenes_of_workload(), rows), &scored());
    const auto is_other = [&](const std::function<void(std::vector<nlohmann::json>&)>& change) {
        auto scenes = scenes_of_workload();
        change(scenes);
        return workload_of(scenes, rows) == nullptr;
    };
    EXPECT_TRUE(is_other([](auto& scenes) { scenes.pop_back(); }));
    EXPECT_TRUE(is_other([](auto& scenes) { scenes[1]["hash"] = "0123456789abcdef"; }));
    EXPECT_TRUE(is_other([](auto& scenes) { scenes[1]["camera_set_hash"] = "0123456789abcdef"; }));
    EXPECT_TRUE(is_other([](auto& scenes) { scenes[1].erase("camera_set_hash"); }));
    EXPECT_TRUE(is_other([](auto& scenes) { scenes[1]["views"] = {0u, 2u}; }));
    EXPECT_TRUE(is_other([](auto& scenes) { scenes[1]["width"] = 1024u; }));
    EXPECT_FALSE(is_other([](auto& scenes) { std::swap(scenes[0], scenes[1]); })) << "in any order";
    const auto is_other_rays = [&](const std::function<void(RowRecord&)>& change) {
        auto changed = rows;
        change(changed[1]);
        return workload_of(scenes_of_workload(), changed) == nullptr;
    };
    EXPECT_TRUE(is_other_rays([](RowRecord& row) { row.ray_hash = *row.ray_hash + 1; }));
    EXPECT_TRUE(is_other_rays([](RowRecord& row) { row.key.ray_order = RayOrder::morton; }));
    EXPECT_FALSE(is_other_rays([](RowRecord& row) {
        row.ray_hash.reset();
        row.outcome = Skipped{};
    })) << "rows that were not traced are of any";
    const std::vector<RowRecord> primary = {rows.front()};
    EXPECT_EQ(workload_of(scenes_of_workload(), primary), nullptr);
}

TEST(Workloads, have_distinct_names_and_pinned_scenes)
{
    for (const Workload& workload : workloads()) {
        for (const std::string& scene : workload.scenes)
            EXPECT_NE(find_pinned(scene), nullptr) << scene;
        EXPECT_EQ(std::ranges::count(workloads(), workload.name, &Workload::name), 1);
        Options options;
        apply_workload(options, std::string(workload.name));
        EXPECT_EQ(options.width, workload.size);
        EXPECT_EQ(options.scenes, workload.scenes);
    }
}

TEST(Workloads, the_first_is_what_bench_measures_by_default)
{
    const Options asked = parse_options({"bench"});
    const Workload& workload = workloads().front();
    EXPECT_EQ(asked.views, workload.views);
    EXPECT_EQ(asked.width, workload.size);
    EXPECT_EQ(asked.height, workload.size);
    EXPECT_TRUE(asked.rays.empty()) << "primary rays";
    for (const SceneRequest& request : scene_requests(asked))
        if (default_scene(scene_label(request.name)) != scene_label(request.name)) {
            EXPECT_EQ(request.name, default_scene(scene_label(request.name)));
            EXPECT_TRUE(request.is_default);
        }
    for (const SceneRequest& request : scene_requests(parse_options({"bench", "--tets", "cdt"})))
        EXPECT_EQ(request.name, scene_label(request.name)) << "pinned scenes have tets for rays";
    EXPECT_TRUE(parse_options({"bench", "--samples", "10"}).exact_samples);
    EXPECT_FALSE(asked.exact_samples);
}

TEST(Brief, is_one_screen_with_five_rows_a_score_what_is_compared_and_trust)
{
    const ResultFile file = read_result(TETRACE_RESULTS "/amd-epyc-zen5-2-cores/2026-11-27-005fd50.json");
    const std::string text = run_again(file, true).sheet.text({.width = 80});
    EXPECT_LE(std::ranges::count(text, '\n'), 22) << "two more are the machine's:\n" << text;
    for (const char* const part :
         {"cdt project half32 packets", "bvh stream robust", "Score     61.00 [59", "No rate   15 rows skipped",
          "bunny 1.23 [1.18, 1.25] of bvh stream robust", "Trust     other processes used"})
        EXPECT_TRUE(contains(std::regex_replace(text, std::regex("\n +"), " "), part)) << part << "\n" << text;
    std::size_t longest = 0;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        longest = std::max(longest, end - at);
    EXPECT_LE(longest, 80u) << text;
}

TEST(Brief, says_of_a_missing_score_what_most_kernels_lack)
{
    ResultFile file = read_result(TETRACE_RESULTS "/amd-epyc-zen5-2-cores/2026-11-27-005fd50.json");
    auto& rows = file.json.at("tetrace").at("rows");
    rows.erase(std::remove_if(rows.begin(), rows.end(), [](const auto& row) { return row.at("scene") == "atrium"; }),
               rows.end());
    const std::string text = run_again(file, true).sheet.text({.width = 80});
    EXPECT_TRUE(contains(text, "Score     none; most often because 1 of 3 rows are missing.")) << text;
}
