#include "bench/measuring/pulse.h"

#include "bench/measuring/figures.h"
#include "bench/measuring/measure.h"
#include "bench/measuring/view_recorder.h"
#include "bench/statistics/statistics.h"
#include "tests/support/row_runs.h"
#include "tests/support/wrapped_session.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// openmp's answers on a device of its own, in as many seconds as a test says.
class PulsedSession : public WrappedSession {
public:
    PulsedSession(std::unique_ptr<Session> inner, const double& seconds)
        : WrappedSession(std::move(inner)), seconds_(&seconds)
    {
    }
    [[nodiscard]] double wait() override
    {
        static_cast<void>(WrappedSession::wait());
        return *seconds_;
    }

private:
    const double* seconds_;
};

/// Two rows, a clock that a test moves, and work that takes as long as it says.
class Pulsed : public testing::Test {
protected:
    Pulsed()
    {
        for (const Layout layout : {Layout::tet80, Layout::tet96}) {
            RowKey key{"cubes", "openmp", {}, RayKind::primary, TetOrder::chains};
            key.kernel.layout = layout;
            rows_.push_back(open_row(key, scene_, options_));
        }
        verify_rows({&rows_[0], &rows_[1]}, scene_, options_);
    }

    [[nodiscard]] Clock clock()
    {
        return [this] { return now_s_; };
    }
    [[nodiscard]] Pulses::Work host()
    {
        return [this] {
            ++taken_;
            return std::optional(host_s_);
        };
    }
    /// A sample of each row, then three seconds of nothing.
    void sample(Pulses& pulses)
    {
        for (RowRun& row : rows_) {
            pulses.take_if_due();
            pulses.sampled(row, now_s_, now_s_ + 1);
            row.samples_s.push_back(1);
            now_s_ += 3;
        }
    }

    Options options_ =
        parse_options({"bench", "--size", "8", "--views", "0,1", "--samples", "10", "--sample-time", "0"});
    SceneWork scene_{loaded_cubes(), options_};
    std::vector<RowRun> rows_;
    double now_s_ = 100, host_s_ = 0.01;
    int taken_ = 0;
};

} // namespace

TEST(Pulse, at_an_interval_is_the_slower_one_of_its_two_neighbours)
{
    const Pulse pulse{"host", {{0, 1.0}, {10, 2.0}, {20, 1.5}}};
    EXPECT_EQ(pulse.fastest_s(), 1.0);
    EXPECT_EQ(pulse.ratio(), 2.0);
    EXPECT_EQ(pulse.ratio_beside(1, 9), 2.0);
    EXPECT_EQ(pulse.ratio_beside(11, 19), 2.0);
    EXPECT_EQ(pulse.ratio_beside(21, 22), 1.5) << "none came after it";
    EXPECT_EQ(pulse.ratio_beside(-2, -1), 1.0) << "none came before it";
}

TEST(Pulse, disturbs_from_a_quarter_on_and_load_from_a_tenth_of_each_processor)
{
    const MachineLoad quiet{0.2, 2, 2}, busy{1.3, 2, 2};
    EXPECT_EQ(disturbance_text(1.24, &quiet), "");
    EXPECT_EQ(disturbance_text(1.25, &quiet), "calibration during its samples took 1.25 times its fastest");
    EXPECT_EQ(disturbance_text({}, &busy), "other processes used 1.30 of 2 CPUs");
    EXPECT_EQ(disturbance_text(6.0, &busy),
              "calibration during its samples took 6.00 times its fastest; other processes used 1.30 of 2 CPUs");
}

TEST_F(Pulsed, a_row_that_a_cpu_quota_stopped_during_its_samples_is_noisy)
{
    Pulses pulses(pointers_to(rows_), host(), clock());
    std::uint64_t periods = 40; // before the run
    pulses.set_throttled_periods([&] { return periods; });
    for (int i = 0; i < 5; ++i) {
        pulses.take();
        pulses.sampled(rows_[0], now_s_, now_s_ + 1);
        periods += 2;
        pulses.sampled(rows_[1], now_s_ + 1, now_s_ + 2);
        periods += 100; // during a calibration, or while nothing is sampled
        for (RowRun& row : rows_)
            row.samples_s.push_back(1);
        now_s_ += 3;
    }
    pulses.take();
    pulses.judge_rows(rows_, MachineLoad{0.1, 1, 2});
    EXPECT_EQ(rows_[0].disturbance, "");
    EXPECT_EQ(rows_[1].disturbance, "the container's CPU quota stopped it 10 times");
    rows_[1].device.kind = DeviceKind::gpu;
    pulses.judge_rows(rows_, {});
    EXPECT_EQ(rows_[1].disturbance, "") << "it ran elsewhere";
}

TEST_F(Pulsed, rows_of_a_machine_that_keeps_its_speed_are_not_noisy)
{
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    for (int i = 0; i < 5; ++i)
        sample(pulses);
    pulses.take();
    pulses.judge_rows(rows_, MachineLoad{0.1, 1, 2});
    for (const RowRun& row : rows_) {
        EXPECT_EQ(row.pulse_ratio, 1.0);
        EXPECT_FALSE(figures_of(row)->noisy) << row.disturbance;
    }
}

// All samples agree, so that neither spread nor interval shows it: the machine was six times slower all the while.
TEST_F(Pulsed, a_row_is_noisy_if_the_machine_was_slower_at_half_of_its_samples)
{
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    host_s_ = 0.06;
    now_s_ += 3;
    for (int i = 0; i < 5; ++i)
        sample(pulses);
    pulses.take();
    pulses.judge_rows(rows_, {});
    for (const RowRun& row : rows_) {
        EXPECT_EQ(row.pulse_ratio, 6.0);
        EXPECT_FALSE(figures_of(row)->kernel_s.noisy());
        EXPECT_TRUE(figures_of(row)->noisy);
        EXPECT_EQ(row.disturbance, "calibration during its samples took 6.00 times its fastest");
        EXPECT_EQ(status_of(row), Status::ok) << "its answers are right all the same";
    }
}

TEST_F(Pulsed, one_slow_moment_does_not_make_a_row_noisy)
{
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    for (int i = 0; i < 5; ++i) {
        host_s_ = i == 2 ? 0.06 : 0.01;
        sample(pulses);
    }
    pulses.take();
    pulses.judge_rows(rows_, {});
    EXPECT_EQ(pulses.found().front().ratio(), 6.0);
    for (const RowRun& row : rows_)
        EXPECT_EQ(row.disturbance, "");
}

TEST_F(Pulsed, is_taken_between_samples_but_not_more_often_than_every_other_second)
{
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    for (int i = 0; i < 100; ++i) {
        pulses.take_if_due();
        now_s_ += 0.1;
    }
    EXPECT_EQ(taken_, 5) << "at 0, 2, 4, 6 and 8 seconds";
}

TEST_F(Pulsed, rows_on_the_host_are_noisy_where_others_used_it)
{
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    sample(pulses);
    pulses.judge_rows(rows_, MachineLoad{1.0, 2, 2});
    EXPECT_EQ(rows_[0].disturbance, "other processes used 1.00 of 2 CPUs");
}

TEST_F(Pulsed, a_gpu_has_its_own_calibration_which_load_of_the_host_does_not_affect)
{
    double gpu_s = 0.5;
    rows_[1].device.kind = DeviceKind::gpu;
    rows_[1].device.name = "a GPU";
    rows_[1].session = std::make_unique<PulsedSession>(std::move(rows_[1].session), gpu_s);
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    gpu_s = 1.0; // its clock went down
    now_s_ += 3;
    for (int i = 0; i < 5; ++i)
        sample(pulses);
    pulses.take();
    pulses.judge_rows(rows_, MachineLoad{1.0, 2, 2});
    EXPECT_EQ(rows_[0].pulse_ratio, 1.0);
    EXPECT_EQ(rows_[1].disturbance, "calibration during its samples took 2.00 times its fastest");
    ASSERT_EQ(pulses.found().size(), 2u);
    EXPECT_EQ(pulses.found()[1].of, "a GPU");
}

TEST_F(Pulsed, a_pulse_ends_where_its_row_fails)
{
    double gpu_s = 0.5;
    rows_[1].device.kind = DeviceKind::gpu;
    rows_[1].session = std::make_unique<PulsedSession>(std::move(rows_[1].session), gpu_s);
    Pulses pulses(pointers_to(rows_), host(), clock());
    pulses.take();
    rows_[1].outcome = Failed{ErrorKind::internal, "the device was lost"};
    pulses.take();
    EXPECT_EQ(pulses.found()[0].readings.size(), 2u);
    EXPECT_EQ(pulses.found()[1].readings.size(), 1u);
}

TEST_F(Pulsed, measuring_takes_it_before_and_after_the_samples_and_passes_it_to_the_rows)
{
    const double slower[] = {0.01, 0.06};
    const Pulses::Work host = [&] { return std::optional(slower[std::min(taken_++, 1)]); };
    const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({}), no_budget(), host);
    ASSERT_EQ(measured.pulses.size(), 1u);
    EXPECT_GE(measured.pulses[0].readings.size(), 2u);
    EXPECT_EQ(measured.pulses[0].ratio(), 6.0);
    for (const RowRun& row : rows_) {
        EXPECT_EQ(row.pulse_ratio, 6.0);
        EXPECT_TRUE(figures_of(row)->noisy);
    }
}
