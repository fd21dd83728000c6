// Samples of `reproduce`: how long they last, next to which rows they are taken, and what happens to throttled ones.
#include "bench/measuring/figures.h"
#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/search_run.h"
#include "tests/rows/throttled_at.h"
#include "tests/rows/timed_session.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::size_t view_total = 4, samples = 3;

/// The same of searches, whose output is a face a ray.
class TimedSearches : public TimedSession {
public:
    using TimedSession::TimedSession;
    void read_output(std::span<std::uint32_t> words) override
    {
        std::fill(words.begin(), words.end(), POISON);
        inner().read_back(words.subspan(GUARD_WORDS, words.size() - 2 * std::size_t{GUARD_WORDS}));
    }
};

/// Is throttled at some of its readings, and the passes at that time are slower.
class SlowWhileThrottled : public ThrottledAt {
public:
    SlowWhileThrottled(double& pass_s, double slow_s, int& asked, int first, int last)
        : ThrottledAt(asked, first, last), pass_s_(&pass_s), slow_s_(slow_s)
    {
    }
    [[nodiscard]] GpuState read() override
    {
        GpuState state = ThrottledAt::read();
        *pass_s_ = state.throttled.empty() ? 1e-3 : slow_s_;
        return state;
    }

private:
    double* pass_s_;
    double slow_s_;
};

/// Four rows over four views, all by openmp, whose passes take as long as a test says.
class Samples : public testing::Test {
protected:
    [[nodiscard]] SceneRun open()
    {
        SceneRun run = open_scene_run({scene_requests(options_).front(), "cubes", our_build, "cubes", false}, options_);
        for (std::size_t i = 0; i < run.rows.size(); ++i)
            run.rows[i].session =
                std::make_unique<TimedSession>(std::move(run.rows[i].session), i, launches_, pass_s_.at(i));
        return run;
    }
    /// The first row is on a GPU, of which this monitor tells.
    [[nodiscard]] SceneRun run_with_gpu(MachineWatch& watch, Journal* journal = nullptr)
    {
        SceneRun scene = open();
        scene.rows[0].device.kind = DeviceKind::gpu;
        scene.rows[0].key.backend = "another";
        run(scene, journal, &watch);
        return scene;
    }
    void run(SceneRun& scene, Journal* journal = nullptr, MachineWatch* watch = nullptr) const
    {
        run_views(scene, options_, {journal, nullptr, watch});
        for (const RowRun& row : scene.rows)
            ASSERT_TRUE(is_whole(row)) << reason_of(row);
    }
    [[nodiscard]] FindMonitor monitor(int first, int last)
    {
        return [=, this](const Device& device) -> std::unique_ptr<GpuMonitor> {
            if (device.kind != DeviceKind::gpu) return nullptr;
            return std::make_unique<SlowWhileThrottled>(pass_s_[0], slow_s_, asked_, first, last);
        };
    }

    Options options_ =
        parse_options({"reproduce", "table3",    "--scene",    "cubes",     "--resolution", "3",        "--size",
                       "8",         "--views",   "0-1281:400", "--backend", "openmp",       "--layout", "tet80,tet96",
                       "--method",  "maria,stp", "--samples",  "3",         "--threads",    "1"});
    std::vector<SeenLaunch> launches_;
    std::vector<double> pass_s_ = std::vector<double>(4, 1e-3);
    double slow_s_ = 5e-3;
    int asked_ = 0;
    Pulses::Work host_ = [] { return std::optional(0.01); };
    TemporaryFolder folder_;
};

std::size_t launches_of(const std::vector<SeenLaunch>& launches, SeenLaunch kind)
{
    return static_cast<std::size_t>(std::ranges::count(launches, kind));
}

} // namespace

TEST_F(Samples, of_a_fast_device_last_as_long_as_asked_for_and_of_a_slow_one_are_a_pass)
{
    pass_s_ = {1e-4, 1e-3, 4e-3, 0.02};
    SceneRun scene = open();
    run(scene);
    const std::uint32_t passes[] = {63, 7, 2, 1}; // of 6.25 ms: the clocks of a device that rested rise by a quarter
    for (std::size_t i = 0; i < 4; ++i) {
        const RowRun& row = scene.rows[i];
        EXPECT_EQ(row.passes, passes[i]);
        for (const ImageRecord& image : scene.images[i]) {
            EXPECT_EQ(image.passes, passes[i]);
            ASSERT_EQ(image.samples_s.size(), samples);
            for (const double seconds : image.samples_s)
                EXPECT_DOUBLE_EQ(seconds, pass_s_[i]) << "of a pass";
        }
        const double rays = 8 * 8;
        EXPECT_NEAR(figures_of(row)->mrays_per_s, 1e-6 * rays / pass_s_[i], 1e-9);
        if (passes[i] > 1) {
            EXPECT_EQ(launches_of(launches_, {i, passes[i]}), view_total * samples);
        }
        // To verify and to warm up, a single pass before each sample or the sample itself, the first view at the end.
        EXPECT_EQ(launches_of(launches_, {i, 1}), view_total * (2 + samples) + 1);
    }
}

TEST_F(Samples, grow_where_a_device_became_faster)
{
    pass_s_[0] = 0.01;
    SceneRun scene = open();
    class Faster : public TimedSession {
    public:
        Faster(std::unique_ptr<Session> inner, std::vector<SeenLaunch>& launches, double& pass_s)
            : TimedSession(std::move(inner), 9, launches, pass_s), pass_s_(&pass_s)
        {
        }
        [[nodiscard]] double wait() override
        {
            const double seconds = TimedSession::wait();
            if (++count_ == 2) *pass_s_ = 1e-3; // after the warm-up
            return seconds;
        }

    private:
        double* pass_s_;
        int count_ = 0;
    };
    scene.rows[0].session = std::make_unique<Faster>(std::move(scene.rows[0].session), launches_, pass_s_[0]);
    run(scene);
    EXPECT_EQ(scene.images[0][0].passes, 5u);
    EXPECT_EQ(scene.images[0][0].samples_s, std::vector<double>(samples, 1e-3));
}

TEST_F(Samples, of_no_time_are_a_pass)
{
    options_.sample_s = 0;
    SceneRun scene = open();
    run(scene);
    for (const SeenLaunch& launch : launches_)
        EXPECT_EQ(launch.passes, 1u);
}

TEST_F(Samples, of_gpus_are_interleaved_with_each_other_and_not_with_those_of_the_host)
{
    options_.sample_s = 0;
    SceneRun scene = open();
    scene.rows[0].device.kind = scene.rows[2].device.kind = DeviceKind::gpu;
    scene.rows[3].device.kind = DeviceKind::emulated; // on the host's processor
    run(scene);
    std::vector<std::size_t> expected;
    for (std::size_t view = 0; view < view_total; ++view) {
        expected.insert(expected.end(), {0, 1, 2, 3}); // verified
        for (const std::vector<std::size_t>& group : {std::vector<std::size_t>{0, 2}, {1, 3}})
            for (std::size_t sample = 0; sample <= samples; ++sample) // the first one warms up
                expected.insert(expected.end(), group.begin(), group.end());
    }
    expected.insert(expected.end(), {0, 1, 2, 3}); // the first view again
    std::vector<std::size_t> launched;
    for (const SeenLaunch& launch : launches_)
        launched.push_back(launch.session);
    EXPECT_EQ(launched, expected);
}

TEST_F(Samples, are_taken_again_while_the_gpu_is_throttled)
{
    MachineWatch watch(host_, {}, host_clock(), 0, monitor(3, 4));
    const SceneRun scene = run_with_gpu(watch);
    const RowRun& row = scene.rows[0];
    ASSERT_TRUE(row.readings.has_value());
    EXPECT_FALSE(scene.rows[1].readings.has_value());
    EXPECT_EQ(row.readings->dropped, 2u);
    EXPECT_EQ(row.readings->states.size(), view_total * samples);
    EXPECT_EQ(row.readings->throttled(), 0u);
    EXPECT_EQ(row.readings->reasons, "heat");
    EXPECT_EQ(row.readings->median(&GpuState::clock_mhz), 1500);
    EXPECT_EQ(scene.images[0][1].gpu->dropped, 2u) << "in the first sample of the second view";
    EXPECT_FALSE(scene.images[0][0].gpu->dropped + scene.images[0][2].gpu->dropped > 0);
    for (const ImageRecord& image : scene.images[0])
        EXPECT_EQ(image.samples_s, std::vector<double>(samples, 1e-3)) << "the slow ones are dropped";
}

TEST_F(Samples, of_a_gpu_that_stays_throttled_make_its_row_noisy_which_says_why)
{
    MachineWatch watch(host_, {}, host_clock(), 0, monitor(0, 1'000'000));
    SceneRun scene = run_with_gpu(watch);
    EXPECT_EQ(scene.rows[0].readings->dropped, 2 * view_total * samples);
    watch.pulses().judge_rows(scene.rows, {});
    EXPECT_TRUE(contains(scene.rows[0].disturbance, "its GPU was throttled in 12 of 12 samples (heat)"))
        << scene.rows[0].disturbance;
    EXPECT_TRUE(figures_of(scene.rows[0])->noisy);
    EXPECT_EQ(scene.rows[1].disturbance, "");
}

TEST_F(Samples, and_the_state_of_a_gpu_during_them_come_back_from_the_journal)
{
    slow_s_ = 1e-3; // the host's clock, which is real, shows no slow pass
    const auto path = folder_ / "r.json.journal";
    {
        Journal journal(path, {{"run", 1}}, false);
        MachineWatch watch(host_, {}, host_clock(), 0, monitor(0, 3)); // the first is kept at last
        (void)run_with_gpu(watch, &journal);
    }
    launches_.clear();
    const int asked = asked_;
    Journal journal(path, {{"run", 1}}, true);
    MachineWatch watch(host_, {}, host_clock(), 0, monitor(0, 1'000'000));
    SceneRun scene = run_with_gpu(watch, &journal);
    EXPECT_EQ(launches_.size(), 4u) << "the first view again, and nothing else";
    EXPECT_EQ(asked_, asked);
    EXPECT_EQ(scene.rows[0].passes, 7u);
    ASSERT_TRUE(scene.rows[0].readings.has_value());
    EXPECT_EQ(scene.rows[0].readings->dropped, 3u);
    EXPECT_EQ(scene.rows[0].readings->throttled(), 1u);
    watch.pulses().judge_rows(scene.rows, {});
    EXPECT_TRUE(contains(scene.rows[0].disturbance, "throttled in 1 of 12 samples")) << scene.rows[0].disturbance;
}

TEST_F(Samples, of_searches_last_as_long_as_asked_for_too)
{
    const Options options =
        parse_options({"reproduce", "table5", "--searches", "20x8", "--backend", "openmp", "--method", "maria",
                       "--layout", "tet80", "--samples", "3", "--threads", "1"});
    SearchRun searches = open_search_run(options);
    ASSERT_EQ(searches.rows.size(), 1u);
    searches.rows[0].session =
        std::make_unique<TimedSearches>(std::move(searches.rows[0].session), 0, launches_, pass_s_[0]);
    run_searches(searches, options, {});
    ASSERT_TRUE(is_whole(searches.rows[0])) << reason_of(searches.rows[0]);
    EXPECT_EQ(searches.rows[0].passes, 7u);
    EXPECT_EQ(launches_of(launches_, {0, 7}), 20 * samples);
    for (const ImageRecord& batch : searches.images[0])
        EXPECT_EQ(batch.samples_s, std::vector<double>(samples, 1e-3));
}
