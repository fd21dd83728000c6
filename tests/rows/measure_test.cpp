#include "bench/measuring/figures.h"
#include "bench/measuring/measure.h"
#include "bench/measuring/verify.h"
#include "tests/support/row_runs.h"
#include "tests/support/wrapped_session.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <new>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// openmp's answers, told one by one: who was launched, and, where asked for, other hits once it is being timed.
class WatchedSession : public WrappedSession {
public:
    WatchedSession(std::unique_ptr<Session> inner, std::size_t number, std::vector<std::size_t>& launched,
                   const bool& changes)
        : WrappedSession(std::move(inner)), number_(number), launched_(&launched), changes_(&changes)
    {
    }
    void launch(const TraceJob& job) override
    {
        launched_->push_back(number_);
        WrappedSession::launch(job);
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
    void launch(const TraceJob& job) override
    {
        lose_at(LostAt::launch);
        WrappedSession::launch(job);
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
            RowKey key{"cubes", "openmp", {}, RayKind::primary, TetOrder::hilbert};
            key.kernel.layout = layout;
            rows_.push_back(open_row(key, scene_, options_));
            RowRun& row = rows_.back();
            row.session =
                std::make_unique<WatchedSession>(std::move(row.session), rows_.size() - 1, launched_, changes_);
        }
        verify_rows({&rows_[0], &rows_[1]}, scene_, options_);
        launched_.clear();
    }

    Options options_ = parse_options({"bench", "--size", "8", "--views", "0,1", "--samples", "30"});
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

TEST_F(Measure, every_row_has_its_samples_each_of_all_views)
{
    const Measurement measured = measure_rows(rows_, options_, read_benchmark_flags({}));
    EXPECT_EQ(measured.samples, 30u);
    EXPECT_FALSE(measured.lowered);
    EXPECT_EQ(launched_.size(), 2u * (1 + 30) * 2) << "a pass to warm up, then samples, of two views";
    for (const RowRun& row : rows_) {
        EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
        ASSERT_EQ(row.samples_s.size(), 30u);
        ASSERT_EQ(row.wall_samples_s.size(), 30u);
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
    EXPECT_EQ(exit_code(rows_, true), exit_code(ErrorKind::internal));
}

TEST_F(Measure, rows_that_are_wrong_are_not_timed)
{
    std::get<Traced>(rows_[0].outcome).different = 1;
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({})));
    EXPECT_TRUE(rows_[0].samples_s.empty());
    EXPECT_EQ(rows_[1].samples_s.size(), 30u);
}
