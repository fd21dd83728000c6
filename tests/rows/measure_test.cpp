#include "bench/measuring/figures.h"
#include "bench/measuring/measure.h"

#include "bench/measuring/view_recorder.h"
#include "bench/terminal/interrupts.h"
#include "tests/rows/throttled_at.h"
#include "tests/rows/timed_session.h"
#include "tests/support/row_runs.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <new>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// openmp's answers, and a list of the launches; if asked for, other hits once it is being timed.
class WatchedSession : public WrappedSession {
public:
    WatchedSession(std::unique_ptr<Session> inner, std::size_t number, std::vector<std::size_t>& launched,
                   const bool& changes)
        : WrappedSession(std::move(inner)), number_(number), launched_(&launched), changes_(&changes)
    {
    }
    void start(std::span<const TraceJob> jobs) override
    {
        launched_->push_back(number_);
        WrappedSession::start(jobs);
    }

private:
    void change(std::span<Hit> hits) override
    {
        if (*changes_) hits[7].t += 1;
    }

    std::size_t number_;
    std::vector<std::size_t>* launched_;
    const bool* changes_;
};

/// A device that is lost at some call.
enum class LostAt { launch, wait, read_back };
class LostSession : public WrappedSession {
public:
    LostSession(std::unique_ptr<Session> inner, LostAt at, std::function<void()> lose)
        : WrappedSession(std::move(inner)), at_(at), lose_(std::move(lose))
    {
    }
    void start(std::span<const TraceJob> jobs) override
    {
        lose_at(LostAt::launch);
        WrappedSession::start(jobs);
    }
    [[nodiscard]] double wait() override
    {
        lose_at(LostAt::wait);
        return WrappedSession::wait();
    }
    void read_output(std::span<std::uint32_t> words) override
    {
        lose_at(LostAt::read_back);
        WrappedSession::read_output(words);
    }

private:
    void lose_at(LostAt call)
    {
        if (call == at_) lose_();
    }

    LostAt at_;
    std::function<void()> lose_;
};

class Measure : public testing::Test {
protected:
    Measure() { set_up_rows(); }

    void set_up_rows()
    {
        rows_.clear();
        for (const Layout layout : {Layout::tet80, Layout::tet96}) {
            RowKey key{"cubes", "openmp", {}, RayKind::primary, TetOrder::chains};
            key.kernel.layout = layout;
            rows_.push_back(open_row(key, scene_, options_));
            RowRun& row = rows_.back();
            row.session =
                std::make_unique<WatchedSession>(std::move(row.session), rows_.size() - 1, launched_, changes_);
        }
        verify_rows({&rows_[0], &rows_[1]}, scene_, options_);
        launched_.clear();
    }

    Options options_ =
        parse_options({"bench", "--size", "8", "--views", "0,1", "--samples", "30", "--sample-time", "0"});
    SceneWork scene_{loaded_cubes(), options_};
    std::vector<RowRun> rows_;
    std::vector<std::size_t> launched_;
    bool changes_ = false;
};

/// Among the samples, which the warm-up of both rows and their two views precedes.
bool first_row_ends_before_the_second_starts(const std::vector<std::size_t>& launched)
{
    return std::is_sorted(launched.begin() + 2 * 2, launched.end());
}

} // namespace

TEST_F(Measure, an_interrupt_leaves_rows_with_five_samples_their_rate_and_others_their_answers)
{
    options_.runs = 2;
    for (const int pulses : {3, 20, 55}) { // one before each of 30 samples of two rows
        const Pulses::Work interrupts = [taken = 0, pulses]() mutable {
            if (++taken == pulses) interrupt();
            return std::optional(0.01);
        };
        double now_s = 0; // the pulse is due before each sample
        Budget hours(1e9, [&] { return now_s += 3; });
        for (RowRun& row : rows_)
            row.samples_s.clear(), row.wall_samples_s.clear(), row.run_samples.clear();
        const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({}), hours, interrupts);
        forget_interrupt();
        EXPECT_EQ(measured.samples, 30u) << "asked for";
        for (const RowRun& row : rows_) {
            EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
            EXPECT_LE(row.samples_s.size(), 30u);
            EXPECT_TRUE(row.samples_s.empty() || row.samples_s.size() >= min_samples) << row.samples_s.size();
            EXPECT_EQ(row.samples_s.empty(), row.run_samples.empty());
        }
        const std::size_t taken = rows_[0].samples_s.size() + rows_[1].samples_s.size();
        EXPECT_EQ(taken == 0, pulses == 3) << taken;
        EXPECT_LT(taken, static_cast<std::size_t>(pulses)) << "rows come in random order, so that one may have all 30";
    }
}

// A calibration that is slow after its first reading disturbs the first samples of both rows.
TEST_F(Measure, a_noisy_row_is_sampled_on_while_the_budget_lasts_unless_the_number_was_asked_for)
{
    const auto samples_with = [&](bool exact, double budget_s) {
        set_up_rows();
        options_.samples = 6;
        options_.exact_samples = exact;
        const Pulses::Work slow_from_the_2nd_to_the_19th = [taken = 0]() mutable {
            ++taken;
            return std::optional(taken > 1 && taken < 20 ? 0.02 : 0.01);
        };
        double now_s = 0; // the pulse is due before each sample
        Budget budget(budget_s, [&] { return now_s += 3; });
        const Measurement measured =
            measure_rows(rows_, options_, read_benchmark_flags({}), budget, slow_from_the_2nd_to_the_19th);
        EXPECT_LE(measured.samples, 6u);
        return rows_[0].samples_s.size();
    };
    EXPECT_EQ(samples_with(true, 1e9), 6u);
    EXPECT_GT(samples_with(false, 1e9), 6u);
    EXPECT_LE(rows_[0].samples_s.size(), 18u);
    EXPECT_EQ(rows_[0].run_samples.size(), 1u);
    EXPECT_LE(samples_with(false, 100), 6u) << "nothing is left of the budget";
}

TEST_F(Measure, a_run_that_goes_on_while_noisy_rows_are_sampled_on_takes_no_sample_twice)
{
    options_.samples = 6;
    options_.exact_samples = false;
    const TemporaryFolder folder;
    // A calibration that stays slow after its first reading: rows are noisy to the end, and have all that they may.
    const auto measure = [&](bool resume, int interrupted_at) {
        set_up_rows();
        Journal journal(folder / "journal", {{"run", 1}}, resume, true);
        const Pulses::Work slow = [taken = 0, interrupted_at]() mutable {
            if (++taken == interrupted_at) interrupt();
            return std::optional(taken > 1 ? 0.02 : 0.01);
        };
        double now_s = 0; // the pulse is due before each sample
        Budget hours(1e9, [&] { return now_s += 3; });
        MachineWatch watch = watch_of(slow, &journal, hours.clock());
        static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({}), {&journal, nullptr, &watch, &hours}));
        forget_interrupt();
    };
    measure(false, 0);
    ASSERT_EQ(rows_[0].samples_s.size(), 18u);
    const bool is_noisy = figures_of(rows_[0])->noisy;
    const Status status = status_of(rows_[0]);
    measure(false, 20);
    std::vector<std::vector<double>> before;
    for (const RowRun& row : rows_) {
        before.push_back(row.samples_s);
        EXPECT_GT(row.samples_s.size(), 6u) << "it was interrupted while it was sampled on";
        EXPECT_LT(row.samples_s.size(), 18u);
    }
    measure(true, 0);
    std::map<std::string, std::size_t> kept;
    for (const nlohmann::json& entry : read_journal(folder / "journal").entries)
        if (entry.contains("rows"))
            for (const auto& [name, samples] : entry["rows"].items())
                kept[name] += samples.at("samples_s").size();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const RowRun& row = rows_[i];
        EXPECT_EQ(row.samples_s.size(), 18u);
        EXPECT_EQ(row.run_samples, std::vector<std::size_t>{18});
        EXPECT_TRUE(std::equal(before[i].begin(), before[i].end(), row.samples_s.begin())) << "those are not repeated";
        EXPECT_EQ(kept[row_name(row.key)], 18u) << "nor kept twice";
        EXPECT_EQ(figures_of(row)->noisy, is_noisy);
        EXPECT_EQ(status_of(row), status);
    }
}

TEST_F(Measure, every_row_has_its_samples_each_of_all_views)
{
    const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({}));
    EXPECT_EQ(measured.samples, 30u);
    EXPECT_FALSE(measured.lowered);
    EXPECT_EQ(launched_.size(), 2u * (2 + 30 + 3 * 2)) << "two views to warm up, samples of both in one launch, and "
                                                          "after a tenth of them a launch for each view";
    for (const RowRun& row : rows_) {
        EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
        ASSERT_EQ(row.samples_s.size(), 30u);
        ASSERT_EQ(row.wall_samples_s.size(), 30u);
        EXPECT_EQ(row.latency_samples_s.size(), 3u);
        EXPECT_EQ(row.launches.joined, 1u);
        EXPECT_EQ(row.launches.single, 2u);
        for (std::size_t i = 0; i < 30; ++i)
            EXPECT_GE(row.wall_samples_s[i], row.samples_s[i]);
    }
}

// Each of the 60!/(30! 30!) orders of samples is as likely: rows one after the other do not come by chance.
TEST_F(Measure, rows_are_interleaved_unless_a_flag_says_otherwise)
{
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_FALSE(first_row_ends_before_the_second_starts(launched_));
    launched_.clear();
    const auto flags = read_benchmark_flags({"--benchmark_enable_random_interleaving=false"});
    static_cast<void>(measure_rows(rows_, options_, flags));
    EXPECT_TRUE(first_row_ends_before_the_second_starts(launched_));
}

TEST_F(Measure, a_sample_lasts_as_long_as_asked_for_by_passes_that_are_one_launch)
{
    rows_.pop_back();
    options_.sample_s = 0.02;
    options_.samples = 3;
    std::vector<SeenLaunch> launches;
    const double pass_s = 1e-3;
    rows_[0].session = std::make_unique<TimedSession>(std::move(rows_[0].session), 0, launches, pass_s);
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    const RowRun& row = rows_[0];
    ASSERT_EQ(status_of(row), Status::ok) << reason_of(row);
    EXPECT_EQ(row.passes, 20u) << "of a millisecond; at first 13, by the two of the warm-up, for a device whose clocks "
                                  "rise by a quarter";
    // Two views to warm up. For every sample: a pass of each view, all of them, and a launch for each view.
    EXPECT_EQ(std::ranges::count(launches, 1u, &SeenLaunch::passes), 2 + 3 * (1 + 2));
    EXPECT_EQ(std::ranges::count(launches, 20u, &SeenLaunch::passes), 2);
    EXPECT_EQ(launches.size(), 2u + 3 * (1 + 1 + 2));
    EXPECT_EQ(row.samples_s, (std::vector<double>{1e-3, 1e-3, 1e-3})) << "the seconds are those of a pass";
    EXPECT_EQ(row.latency_samples_s, (std::vector<double>{2e-3, 2e-3, 2e-3}));
    const auto figures = figures_of(row);
    EXPECT_DOUBLE_EQ(figures->mrays_per_s, 1e-6 * 2 * 64 / 1e-3);
    EXPECT_DOUBLE_EQ(figures->latency_mrays_per_s.value(), 1e-6 * 2 * 64 / 2e-3);
    EXPECT_DOUBLE_EQ(figures->latency_s.value(), 1e-3);
    EXPECT_FALSE(figures->fixed_s.has_value()) << "everything would be fixed";
}

TEST_F(Measure, views_whose_hits_exceed_a_buffer_together_are_launched_in_several_batches)
{
    const Options four =
        parse_options({"bench", "--size", "16", "--views", "0-3", "--samples", "3", "--sample-time", "0"});
    SceneWork scene{loaded_cubes(), four};
    std::vector<RowRun> rows;
    rows.push_back(open_row({"cubes", "openmp", {}, RayKind::primary, TetOrder::chains}, scene, four));
    rows[0].session = std::make_unique<WatchedSession>(std::move(rows[0].session), 0, launched_, changes_);
    verify_rows({&rows[0]}, scene, four);
    launched_.clear();
    rows[0].max_buffer_bytes = 20'000; // of two views, which have 6656 bytes each and begin at multiples of 4096
    static_cast<void>(measure_rows(rows, four, read_benchmark_flags({})));
    EXPECT_EQ(status_of(rows[0]), Status::ok) << reason_of(rows[0]);
    EXPECT_EQ(rows[0].batches, (std::vector<ViewBatch>{{0, 1}, {2, 3}}));
    EXPECT_EQ(launched_.size(), 4u + 3 * 2 + 4) << "to warm up, samples, and a pass with a launch for each view";
    rows[0].max_buffer_bytes = 1;
    EXPECT_EQ(joined_views(rows[0], batch_limit(rows[0], 1)), single_views(rows[0]));
    rows[0].max_buffer_bytes = 0;
    EXPECT_EQ(joined_views(rows[0], batch_limit(rows[0], 1)), (std::vector<ViewBatch>{{0, 1, 2, 3}}));
    rows[0].device.memory_bytes = 3 * 5 * 20'000;
    EXPECT_EQ(joined_views(rows[0], batch_limit(rows[0], 5)).size(), 2u) << "five rows share a third of the memory";
}

TEST_F(Measure, given_rays_of_all_views_are_one_launch_with_the_hits_of_each)
{
    for (const RayKind kind : {RayKind::shadow, RayKind::diffuse})
        for (const Layout layout : {Layout::tet80, Layout::bvh2}) {
            RowKey key{"cubes", "openmp", {}, kind, TetOrder::chains};
            key.kernel.task = Task::rays;
            key.kernel.layout = layout;
            if (layout == Layout::bvh2) key.kernel.structure = Structure::bvh, key.kernel.method = Method::single;
            std::vector<RowRun> rows;
            rows.push_back(open_row(key, scene_, options_));
            ASSERT_EQ(status_of(rows[0]), Status::ok) << reason_of(rows[0]);
            verify_rows({&rows[0]}, scene_, options_);
            const auto jobs = prepare_batch(rows[0], {0, 1});
            ASSERT_EQ(jobs.size(), 1u);
            EXPECT_EQ(jobs[0].rays(), ray_count(rows[0], 0) + ray_count(rows[0], 1));
            EXPECT_EQ(traced(rows[0])->totals.rays, jobs[0].rays());
            static_cast<void>(measure_rows(rows, options_, read_benchmark_flags({})));
            EXPECT_EQ(status_of(rows[0]), Status::ok) << reason_of(rows[0]);
            EXPECT_EQ(rows[0].launches.joined, 1u);
        }
}

TEST_F(Measure, rows_on_gpus_are_interleaved_only_with_each_other)
{
    for (const std::size_t row : {0u, 1u}) {
        set_up_rows();
        rows_[row].device.kind = DeviceKind::gpu;
        // By a clock that does not move, so that no calibration is due among the samples, however busy the machine is.
        Budget still(std::numeric_limits<double>::infinity(), [] { return 0.0; });
        static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({}), still));
        // The warm-up comes before them, of the GPU with a joined launch, and the GPU's pulse, which is its row's,
        // after them.
        const auto samples = std::vector(launched_.begin() + 2 * 2 + 1, launched_.end() - 3);
        EXPECT_EQ(samples.front(), row) << "GPUs come first";
        EXPECT_TRUE(row == 0 ? std::ranges::is_sorted(samples) : std::ranges::is_sorted(samples, std::greater<>()));
    }
    const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({}));
}

TEST_F(Measure, a_sample_is_taken_again_while_its_gpu_is_throttled)
{
    rows_[0].device.kind = DeviceKind::gpu;
    rows_[0].key.backend = "another";
    int asked = 0;
    const auto find = [&](const Device& device) -> std::unique_ptr<GpuMonitor> {
        if (device.kind != DeviceKind::gpu) return nullptr;
        return std::make_unique<ThrottledAt>(asked, 3, 4);
    };
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({}), no_budget(), {}, find));
    ASSERT_TRUE(rows_[0].readings.has_value());
    EXPECT_FALSE(rows_[1].readings.has_value());
    EXPECT_EQ(rows_[0].samples_s.size(), 30u);
    EXPECT_EQ(rows_[0].readings->states.size(), 30u);
    EXPECT_EQ(rows_[0].readings->dropped, 2u);
    EXPECT_EQ(rows_[0].readings->throttled(), 0u);
    EXPECT_EQ(rows_[0].readings->reasons, "heat");
    EXPECT_EQ(rows_[0].readings->median(&GpuState::clock_mhz), 1500);
    EXPECT_EQ(rows_[0].readings->median(&GpuState::power_w), std::nullopt);
}

TEST_F(Measure, a_row_whose_gpu_stays_throttled_is_noisy_and_says_why)
{
    rows_[0].device.kind = DeviceKind::gpu;
    rows_[0].key.backend = "another";
    int asked = 0;
    const auto find = [&](const Device&) { return std::make_unique<ThrottledAt>(asked, 0, 1'000'000); };
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({}), no_budget(), {}, find));
    EXPECT_EQ(rows_[0].readings->dropped, 2u * 30);
    EXPECT_EQ(rows_[0].readings->throttled(), 30u);
    EXPECT_TRUE(contains(rows_[0].disturbance, "its GPU was throttled in 30 of 30 samples (heat)"))
        << rows_[0].disturbance;
    EXPECT_TRUE(figures_of(rows_[0])->noisy);
}

TEST_F(Measure, a_device_that_is_lost_ends_its_row_and_the_others_go_on)
{
    for (const LostAt at : {LostAt::launch, LostAt::wait, LostAt::read_back}) {
        set_up_rows();
        rows_[0].session = std::make_unique<LostSession>(
            std::move(rows_[0].session), at, [] { throw Error(ErrorKind::internal, "the device was lost"); });
        static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
        EXPECT_EQ(status_of(rows_[0]), Status::error);
        EXPECT_EQ(reason_of(rows_[0]), "the device was lost");
        EXPECT_EQ(rows_[0].session, nullptr) << "its memory is free for the others";
        EXPECT_EQ(status_of(rows_[1]), Status::ok);
        EXPECT_EQ(rows_[1].samples_s.size(), 30u);
    }
}

TEST_F(Measure, a_device_that_is_lost_among_the_samples_leaves_no_rate)
{
    int calls = 0;
    rows_[0].session = std::make_unique<LostSession>(std::move(rows_[0].session), LostAt::wait, [&] {
        if (++calls > 10) throw Error(ErrorKind::internal, "the device was lost");
    });
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_EQ(status_of(rows_[0]), Status::error);
    EXPECT_FALSE(figures_of(rows_[0]).has_value());
    EXPECT_EQ(rows_[1].samples_s.size(), 30u);
}

TEST_F(Measure, an_allocation_that_fails_is_unsupported_and_the_others_go_on)
{
    rows_[0].session =
        std::make_unique<LostSession>(std::move(rows_[0].session), LostAt::launch, [] { throw std::bad_alloc(); });
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_EQ(status_of(rows_[0]), Status::unsupported);
    EXPECT_EQ(rows_[1].samples_s.size(), 30u);
}

TEST_F(Measure, repetitions_are_taken_in_place_of_the_samples_asked_for)
{
    const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({"--benchmark_repetitions=4"}));
    EXPECT_EQ(measured.samples, 4u);
    EXPECT_FALSE(measured.lowered);
}

TEST_F(Measure, hits_that_change_after_verification_are_an_error_without_a_rate)
{
    changes_ = true;
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    for (const RowRun& row : rows_) {
        EXPECT_EQ(status_of(row), Status::error);
        EXPECT_NE(reason_of(row).find("changed between verifying and measuring"), std::string::npos) << reason_of(row);
    }
    EXPECT_EQ(exit_code(records_of(rows_), true), exit_code(ErrorKind::internal));
}

TEST_F(Measure, hits_that_only_views_in_flight_together_change_are_an_error_that_names_the_view)
{
    class Muddled : public WrappedSession {
    public:
        using WrappedSession::WrappedSession;

    private:
        void change(std::span<Hit> hits) override
        {
            if (hits.size() > 64) hits[64].t += 1;
        }
    };
    rows_[0].session = std::make_unique<Muddled>(std::move(rows_[0].session));
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_EQ(status_of(rows_[0]), Status::error);
    EXPECT_EQ(reason_of(rows_[0]), "the hits of view 1 changed between verifying and measuring");
    EXPECT_EQ(status_of(rows_[1]), Status::ok);
}

namespace {

/// Answers wrongly in the second output of launches in flight, from the read-back of that number on.
class SecondOutputWrong : public WrappedSession {
public:
    SecondOutputWrong(std::unique_ptr<Session> inner, int from) : WrappedSession(std::move(inner)), from_(from) {}

private:
    void change(std::span<Hit> hits) override
    {
        const std::size_t both_views = 2 * 64;
        if (hits.size() == 2 * both_views && ++read_ >= from_) hits[both_views + 64].t += 1;
    }

    int from_, read_ = 0;
};

} // namespace

TEST_F(Measure, launches_in_flight_are_verified_in_each_output_before_and_after_the_samples)
{
    for (const int wrong_from : {1, 2, 3}) { // before, after, never
        RowKey key{"cubes", "cuda-host", {}, RayKind::primary, TetOrder::chains};
        key.in_flight = 2;
        rows_.clear();
        launched_.clear();
        rows_.push_back(open_row(key, scene_, options_));
        RowRun& row = rows_.front();
        ASSERT_EQ(status_of(row), Status::ok) << reason_of(row);
        row.session = std::make_unique<SecondOutputWrong>(std::move(row.session), wrong_from);
        row.session = std::make_unique<WatchedSession>(std::move(row.session), 0, launched_, changes_);
        verify_rows({&row}, scene_, options_);
        static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
        EXPECT_EQ(launched_.size() > 10, wrong_from > 1) << "no sample of a row that is wrong before";
        if (wrong_from > 2) {
            EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
            EXPECT_EQ(row.passes, 2u) << "one for each output";
            EXPECT_TRUE(figures_of(row)->latency_s.has_value());
            continue;
        }
        EXPECT_EQ(status_of(row), Status::error);
        EXPECT_EQ(reason_of(row),
                  "the hits of view 1 in output 2 of 2 launches in flight changed between verifying and "
                  "measuring");
    }
}

TEST_F(Measure, rows_that_are_wrong_are_not_timed)
{
    std::get<Traced>(rows_[0].outcome).different = 1;
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_TRUE(rows_[0].samples_s.empty());
    EXPECT_EQ(rows_[1].samples_s.size(), 30u);
}

namespace {

/// openmp, whose sessions take longer from one to the next.
class AgeingBackend : public Backend {
public:
    explicit AgeingBackend(std::vector<SeenLaunch>& launches) : launches_(&launches) {}
    [[nodiscard]] std::string name() const override { return "openmp"; }
    [[nodiscard]] std::string clock() const override { return inner_->clock(); }
    [[nodiscard]] const std::vector<Device>& devices() const override { return inner_->devices(); }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return inner_->has_kernel(kernel); }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        return inner_->why_not(device, kernel);
    }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        pass_s_.push_back(1e-3 * static_cast<double>(pass_s_.size() + 2));
        return std::make_unique<TimedSession>(inner_->open(device, kernel, scene, options), pass_s_.size(), *launches_,
                                              pass_s_.back());
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        return inner_->probe(device, math, operations);
    }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    Backend* inner_ = &reference_backend();
    std::vector<SeenLaunch>* launches_;
    std::deque<double> pass_s_;
};

} // namespace

TEST_F(Measure, each_run_opens_the_sessions_again_and_has_its_own_samples)
{
    std::vector<SeenLaunch> launches;
    AgeingBackend ageing(launches);
    for (RowRun& row : rows_)
        row.backend = &ageing;
    options_.runs = 3;
    options_.samples = 5;
    const double first_s = 1e-3;
    rows_[0].session = std::make_unique<TimedSession>(std::move(rows_[0].session), 0, launches, first_s);
    const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({}));
    EXPECT_EQ(measured.runs, 3u);
    EXPECT_EQ(measured.samples, 5u);
    const RowRun& row = rows_[0];
    ASSERT_EQ(status_of(row), Status::ok) << reason_of(row);
    EXPECT_EQ(row.run_samples, (std::vector<std::size_t>{5, 5, 5}));
    EXPECT_EQ(row.latency_samples_s.size(), 3u) << "one of each run";
    const auto runs = samples_of_runs(row);
    EXPECT_EQ(runs[0], std::vector<double>(5, 1e-3));
    EXPECT_EQ(runs[1], std::vector<double>(5, 2e-3)) << "the first session that was opened again";
    EXPECT_EQ(runs[2], std::vector<double>(5, 4e-3)) << "after the second run of both rows";
    EXPECT_EQ(samples_of_runs(rows_[1])[2], std::vector<double>(5, 5e-3));
    EXPECT_LT(launches.front().session, launches.back().session);
}

TEST_F(Measure, a_row_that_cannot_be_opened_again_ends_with_its_reason_and_no_rate)
{
    std::vector<SeenLaunch> launches;
    class Gone : public AgeingBackend {
    public:
        using AgeingBackend::AgeingBackend;
        [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId&, const SceneData&,
                                                    const SessionOptions&) override
        {
            throw Error(ErrorKind::internal, "the device is gone");
        }
    } gone(launches);
    rows_[0].backend = &gone;
    options_.runs = 2;
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_EQ(reason_of(rows_[0]), "the device is gone");
    EXPECT_FALSE(figures_of(rows_[0]).has_value());
    EXPECT_EQ(rows_[1].run_samples, (std::vector<std::size_t>{30, 30}));
}
