#include "bench/measuring/machine_watch.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/search_run.h"
#include "bench/rows/rows.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;
using nlohmann::json;

namespace {

/// Rows on the host, a clock that moves a second whenever it is read, and a pulse as long as a test says.
class Watched : public testing::Test {
protected:
    [[nodiscard]] Clock clock()
    {
        return [this] { return now_s_ += 1; };
    }
    [[nodiscard]] Pulses::Work host()
    {
        return [this] {
            ++taken_;
            return std::optional(host_s_);
        };
    }
    [[nodiscard]] SceneRun open() const
    {
        return open_scene_run({scene_requests(options_).front(), "cubes", our_build, "cubes", false}, options_);
    }
    void run(SceneRun& run, Journal* journal, MachineWatch& watch) const
    {
        run_views(run, options_, {journal, nullptr, &watch});
    }

    Options options_ =
        parse_options({"reproduce", "table3",  "--scene",    "cubes",     "--resolution",  "3",        "--size",
                       "8",         "--views", "0-1281:400", "--backend", "openmp",        "--layout", "tet80",
                       "--method",  "maria",   "--samples",  "3",         "--sample-time", "0"});
    TemporaryFolder folder_;
    double now_s_ = 0, host_s_ = 0.01;
    int taken_ = 0;
};

} // namespace

TEST_F(Watched, rows_of_a_steady_machine_are_not_disturbed)
{
    MachineWatch watch(host(), {}, clock());
    SceneRun cubes = open();
    run(cubes, nullptr, watch);
    watch.pulses().judge_rows(cubes.rows, {});
    EXPECT_GE(taken_, 4) << "with each view";
    for (const RowRun& row : cubes.rows) {
        EXPECT_EQ(row.pulse_ratio, 1.0);
        EXPECT_EQ(row.disturbance, "");
    }
}

TEST_F(Watched, a_scene_is_noisy_where_the_machine_was_slower_than_in_another)
{
    MachineWatch watch(host(), {}, clock());
    SceneRun first = open(), second = open();
    run(first, nullptr, watch);
    host_s_ = 0.06;
    run(second, nullptr, watch);
    watch.pulses().judge_rows(first.rows, {});
    watch.pulses().judge_rows(second.rows, {});
    EXPECT_EQ(first.rows[0].disturbance, "");
    EXPECT_EQ(second.rows[0].disturbance, "calibration during its samples took 6.00 times its fastest");
    EXPECT_TRUE(figures_of(second.rows[0])->noisy);
}

TEST_F(Watched, searches_are_watched_too)
{
    const Options options =
        parse_options({"reproduce", "table5", "--searches", "20x8", "--backend", "openmp", "--method", "maria",
                       "--layout", "tet80", "--samples", "3", "--sample-time", "0"});
    MachineWatch watch(host(), {}, clock());
    watch.pulses().take();
    host_s_ = 0.02;
    SearchRun searches = open_search_run(options);
    run_searches(searches, options, {.watch = &watch});
    watch.pulses().judge_rows(searches.rows, {});
    for (const RowRun& row : searches.rows)
        EXPECT_EQ(row.pulse_ratio, 2.0);
}

TEST_F(Watched, what_a_cpu_quota_stopped_is_added_up_over_the_processes_of_a_run)
{
    const json stretch = {{"load",
                           {{"others", 0.0},
                            {"average", 1.0},
                            {"processors", 2u},
                            {"seconds", 3.0},
                            {"throttled_periods", 4u},
                            {"throttled_s", 0.25}}}};
    MachineWatch watch(host(), {stretch, stretch}, clock());
    ASSERT_TRUE(watch.load().has_value());
    EXPECT_EQ(watch.load()->throttling.periods, 8u);
    EXPECT_EQ(watch.load()->throttling.seconds, 0.5);
}

// Its pulse is the first view once more: the answers to the current one must be read before or after it.
TEST_F(Watched, a_gpu_has_its_own_calibration_in_each_scene_and_keeps_its_answers)
{
    MachineWatch watch(host(), {}, clock());
    std::vector<SceneRun> scenes;
    for (int i = 0; i < 2; ++i) {
        SceneRun& scene = scenes.emplace_back(open());
        for (RowRun& row : scene.rows)
            row.device.kind = DeviceKind::gpu;
        scene.rows[0].device.name = "a GPU";
        run(scene, nullptr, watch);
        ASSERT_TRUE(is_whole(scene.rows[0])) << reason_of(scene.rows[0]);
    }
    const auto found = watch.pulses().found();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[1].of, "a GPU, cubes") << "of the same name, so of the same work";
    watch.pulses().judge_rows(scenes[0].rows, MachineLoad{2, 2, 2});
    EXPECT_GE(scenes[0].rows[0].pulse_ratio, 1.0);
    EXPECT_EQ(scenes[0].rows[0].disturbance.find("others used"), std::string::npos) << "the host's load is not its own";
}

TEST_F(Watched, searches_on_a_gpu_have_one_too)
{
    const Options options =
        parse_options({"reproduce", "table5", "--searches", "50x8", "--backend", "openmp", "--method", "maria",
                       "--layout", "tet80", "--samples", "3", "--sample-time", "0"});
    MachineWatch watch(host(), {}, clock());
    SearchRun searches = open_search_run(options);
    for (RowRun& row : searches.rows)
        row.device.kind = DeviceKind::gpu;
    searches.rows[0].device.name = "a GPU";
    run_searches(searches, options, {.watch = &watch});
    for (const RowRun& row : searches.rows)
        EXPECT_TRUE(is_whole(row)) << reason_of(row);
    ASSERT_GE(watch.pulses().found().size(), 2u);
    EXPECT_EQ(watch.pulses().found()[1].of, "a GPU, exit searches");
}

TEST_F(Watched, a_resumed_run_knows_the_readings_of_its_first_process)
{
    const auto path = folder_ / "r.json.journal";
    {
        Journal journal(path, {{"run", 1}}, false);
        MachineWatch watch = watch_of(host(), &journal, clock());
        SceneRun cubes = open();
        run(cubes, &journal, watch);
        EXPECT_TRUE(watch.load().has_value()) << "of the last view at the latest";
    }
    now_s_ = 0; // another process has another clock
    host_s_ = 0.06;
    Journal journal(path, {{"run", 1}}, true);
    MachineWatch watch = watch_of(host(), &journal, clock());
    SceneRun cubes = open();
    const int before = taken_;
    run(cubes, &journal, watch);
    EXPECT_EQ(taken_, before) << "all views are in the journal";
    EXPECT_TRUE(watch.load().has_value());
    EXPECT_GE(watch.pulses().found().front().readings.size(), 4u);
    watch.pulses().take();
    const auto& readings = watch.pulses().found().front().readings;
    EXPECT_EQ(readings.back().seconds, 0.06);
    for (std::size_t i = 1; i < readings.size(); ++i)
        EXPECT_LT(readings[i - 1].at_s, readings[i].at_s) << "one clock through all processes";
    watch.pulses().judge_rows(cubes.rows, {});
    EXPECT_EQ(cubes.rows[0].pulse_ratio, 1.0) << "the samples are of the first process";
}

TEST_F(Watched, a_damaged_reading_in_the_journal_is_refused)
{
    const auto path = folder_ / "r.json.journal";
    Journal(path, {{"run", 1}}, false)
        .append({{"scene", "cubes"}, {"machine", {{"pulses", {{{"of", "host"}, {"readings", {{0, -1}}}}}}}}});
    Journal journal(path, {{"run", 1}}, true);
    EXPECT_THROW(static_cast<void>(watch_of(host(), &journal, clock())), Error);
}
