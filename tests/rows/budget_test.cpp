#include "bench/measuring/budget.h"
#include "bench/measuring/measure.h"
#include "bench/measuring/view_recorder.h"
#include "bench/reproduce/search_run.h"
#include "core/rays/search_set.h"
#include "tests/support/row_runs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wrapped_session.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// openmp's answers, for which a ray takes as long as a test says, on a clock that nothing else moves.
class BudgetedSession : public WrappedSession {
public:
    BudgetedSession(std::unique_ptr<Session> inner, double& now_s, const double& ray_s, double first_launch_s)
        : WrappedSession(std::move(inner)), now_s_(&now_s), ray_s_(&ray_s), compile_s_(first_launch_s)
    {
    }
    void start(std::span<const TraceJob> jobs) override
    {
        *now_s_ += compile_s_;
        for (const TraceJob& job : jobs)
            *now_s_ += *ray_s_ * static_cast<double>(job.rays());
        compile_s_ = 0;
        WrappedSession::start(jobs);
    }

private:
    double* now_s_;
    const double* ray_s_;
    double compile_s_;
};

/// Keeps the fewest rays that it was given.
class RaysKeptSession : public WrappedSession {
public:
    RaysKeptSession(std::unique_ptr<Session> inner, std::vector<Quad>& fewest)
        : WrappedSession(std::move(inner)), fewest_(&fewest)
    {
    }
    void set_rays(std::span<const Quad> quads) override
    {
        if (fewest_->empty() || quads.size() < fewest_->size()) fewest_->assign(quads.begin(), quads.end());
        WrappedSession::set_rays(quads);
    }

private:
    std::vector<Quad>* fewest_;
};

/// A row needs 2 views * (verified, warmed up, 5 samples, 1 single pass) and 1 view again: 17 views. A view is 16 x 16
/// rays. The first estimate takes at most four launches of 64 rays.
constexpr double view_rays = 256, views_needed = 17, views_estimated = 1;

class BudgetOfRows : public testing::Test {
protected:
    /// Opens a row of openmp's that calls itself `backend` and whose views take so long.
    std::size_t add_row(Layout layout, double view_s, const std::string& backend = "other", double first_launch_s = 0)
    {
        RowKey key{"cubes", "openmp", {}, RayKind::primary, TetOrder::chains};
        key.kernel.layout = layout;
        rows_.push_back(open_row(key, scene_, options_));
        RowRun& row = rows_.back();
        ray_s_.push_back(std::make_unique<double>(view_s / view_rays));
        row.session = std::make_unique<BudgetedSession>(std::move(row.session), now_s_, *ray_s_.back(), first_launch_s);
        row.key.backend = backend;
        return rows_.size() - 1;
    }

    Budget budget_of(double seconds)
    {
        return Budget(seconds, [this] { return now_s_; });
    }

    /// As `bench` runs the rows.
    Measurement run(Budget& limit)
    {
        limit.plan(rows_, options_.samples);
        std::vector<RowRun*> pointers;
        for (RowRun& row : rows_)
            pointers.push_back(&row);
        verify_rows(pointers, scene_, options_, {}, {.budget = &limit});
        return measure_rows(rows_, options_, read_benchmark_flags({}), limit);
    }

    /// Two rows of a second per view, with time for this many samples of both views over the minimum; the budget is
    /// kept.
    Measurement run_two_rows(double more_samples)
    {
        rows_.reserve(2);
        for (const Layout layout : {Layout::tet80, Layout::tet96})
            add_row(layout, 1);
        Budget limit = budget_of(2 * (views_needed + views_estimated + more_samples * 2));
        const Measurement measured = run(limit);
        EXPECT_GE(limit.left_s(), 0);
        return measured;
    }

    void expect_measured(std::size_t row) const
    {
        EXPECT_EQ(status_of(rows_[row]), Status::ok) << reason_of(rows_[row]);
        EXPECT_GE(rows_[row].samples_s.size(), min_samples);
    }

    void expect_skipped(std::size_t row) const
    {
        EXPECT_EQ(status_of(rows_[row]), Status::skipped);
        EXPECT_TRUE(rows_[row].samples_s.empty());
        EXPECT_NE(reason_of(rows_[row]).find(with_budget), std::string::npos) << reason_of(rows_[row]);
    }

    Options options_ = parse_options({"bench", "--size", "16", "--views", "0,1", "--sample-time", "0"});
    SceneWork scene_{loaded_cubes(), options_};
    std::vector<RowRun> rows_;
    std::vector<std::unique_ptr<double>> ray_s_;
    double now_s_ = 100;
};

} // namespace

TEST_F(BudgetOfRows, skips_a_slow_row_with_its_cost_and_measures_the_others)
{
    for (const std::size_t slow : {0, 1, 2}) {
        rows_.clear();
        rows_.reserve(3);
        for (std::size_t row = 0; row < 3; ++row)
            add_row(row == 1 ? Layout::tet96 : Layout::tet80, row == slow ? 100 : 1);
        const double start_s = now_s_;
        Budget limit = budget_of(100);
        static_cast<void>(run(limit));
        for (std::size_t row = 0; row < 3; ++row)
            row == slow ? expect_skipped(row) : expect_measured(row);
        EXPECT_NE(reason_of(rows_[slow]).find("would take about 28 min 20 s"), std::string::npos)
            << reason_of(rows_[slow]);
        EXPECT_EQ(exit_code(records_of(rows_), true), 0) << "a row that is skipped does not fail the run";
        EXPECT_LE(now_s_ - start_s, 100 * 1.25);
    }
}

TEST_F(BudgetOfRows, of_rows_that_are_only_verified_counts_no_samples)
{
    rows_.reserve(2);
    for (const double view_s : {1.0, 10.0})
        add_row(view_s == 1 ? Layout::tet80 : Layout::tet96, view_s);
    Budget enough = budget_of(11 * (2 + 1 + views_estimated)); // two views and one of them again
    enough.plan(rows_, 0);
    EXPECT_EQ(status_of(rows_[1]), Status::ok) << reason_of(rows_[1]);
    Budget less = budget_of(11 * 2);
    less.plan(rows_, 0);
    EXPECT_EQ(status_of(rows_[0]), Status::ok) << reason_of(rows_[0]);
    expect_skipped(1);
}

// Rows of exit searches do not belong to a scene. The budget is a third of the run's.
TEST_F(BudgetOfRows, of_searches_skips_the_slowest_row_and_names_what_the_run_needs)
{
    SearchRun searches =
        open_search_run(parse_options({"reproduce", "table5", "--searches", "4x64", "--backend", "openmp", "--method",
                                       "maria,plane,plucker", "--layout", "tet80"}));
    std::erase_if(searches.rows, [](const RowRun& row) { return row.key.threads != 1; });
    ASSERT_EQ(searches.rows.size(), 3u);
    const SearchRays rays = search_rays(0, searches.batch_tets, 64);
    for (RowRun& row : searches.rows) {
        const double batch_s = &row == &searches.rows[1] ? 100 : 1;
        ray_s_.push_back(std::make_unique<double>(batch_s / static_cast<double>(rays.count())));
        row.session = std::make_unique<BudgetedSession>(std::move(row.session), now_s_, *ray_s_.back(), 0);
    }
    Budget limit(
        150, [this] { return now_s_; }, 3);
    limit.plan_batches(searches.rows, 3, 0, 2,
                       rays.quads); // of 2 batches: verified, warmed up, 3 samples and a pass: 11
    for (const std::size_t fast : {0, 2})
        EXPECT_EQ(status_of(searches.rows[fast]), Status::ok) << reason_of(searches.rows[fast]);
    EXPECT_EQ(status_of(searches.rows[1]), Status::skipped);
    const std::string reason = reason_of(searches.rows[1]);
    EXPECT_NE(reason.find("would take about 18 min 20 s"), std::string::npos) << reason;
    const auto at = reason.find(with_budget);
    ASSERT_NE(at, std::string::npos) << reason;
    const double minutes = std::stod(reason.substr(at + std::string(with_budget).size()));
    EXPECT_GT(minutes * 60, 3 * 1122) << reason;
    EXPECT_LT(minutes * 60, 3 * 1.25 * (1122 + 300) + 60) << reason;
}

TEST_F(BudgetOfRows, of_views_one_by_one_counts_those_that_are_left)
{
    rows_.reserve(2);
    for (const double view_s : {1.0, 10.0})
        add_row(view_s == 1 ? Layout::tet80 : Layout::tet96, view_s);
    // A view is verified, warmed up and sampled three times; the first is traced once more at the end.
    Budget enough = budget_of(11 * (2 * 5 + 1 + views_estimated));
    enough.plan_views(rows_, 3, 0, 0);
    EXPECT_EQ(status_of(rows_[1]), Status::ok) << reason_of(rows_[1]);
    Budget of_the_last = budget_of(11 * (5 + 1 + views_estimated));
    of_the_last.plan_views(rows_, 3, 0, 1);
    EXPECT_EQ(status_of(rows_[1]), Status::ok) << "the first view is in the journal: " << reason_of(rows_[1]);
    now_s_ += 40; // the machine slows down
    of_the_last.view_done();
    EXPECT_EQ(status_of(rows_[1]), Status::ok) << "no view is left: " << reason_of(rows_[1]);
    Budget of_both = budget_of(11 * (5 + 1 + views_estimated));
    of_both.plan_views(rows_, 3, 0, 0);
    EXPECT_EQ(status_of(rows_[0]), Status::ok) << reason_of(rows_[0]);
    expect_skipped(1);
}

TEST_F(BudgetOfRows, that_all_rows_fit_gives_them_all_samples_asked_for)
{
    const Measurement measured = run_two_rows(5);
    EXPECT_EQ(measured.samples, 10u);
    EXPECT_FALSE(measured.lowered);
}

TEST_F(BudgetOfRows, between_five_samples_and_ten_takes_what_fits_and_says_so)
{
    const Measurement measured = run_two_rows(2);
    EXPECT_EQ(measured.samples, 7u);
    EXPECT_TRUE(measured.lowered);
}

TEST_F(BudgetOfRows, one_row_is_measured_however_small_it_is_the_fastest_of_those_estimated)
{
    for (const double seconds : {0.001, 1.0, 10.0}) {
        rows_.clear();
        rows_.reserve(3);
        for (const double view_s : {1000.0, 100.0, 2000.0})
            add_row(view_s == 100 ? Layout::tet96 : Layout::tet80, view_s);
        Budget limit = budget_of(seconds);
        testing::internal::CaptureStderr();
        static_cast<void>(run(limit));
        const std::string said = testing::internal::GetCapturedStderr();
        EXPECT_TRUE(contains(said, "even one row would take about ")) << said;
        EXPECT_TRUE(contains(said, "it is measured anyway")) << said;
        std::size_t measured = 0;
        for (const RowRun& row : rows_) {
            measured += status_of(row) == Status::ok && row.samples_s.size() >= min_samples;
            EXPECT_TRUE(status_of(row) == Status::ok || contains(reason_of(row), "--budget ")) << reason_of(row);
        }
        EXPECT_EQ(measured, 1u) << seconds;
        EXPECT_EQ(exit_code(records_of(rows_), true), 0);
    }
    rows_.clear();
    rows_.reserve(2);
    add_row(Layout::tet80, 10);
    add_row(Layout::tet96, 1);
    Budget both_estimated = budget_of(10 * views_estimated + 1);
    static_cast<void>(run(both_estimated));
    expect_skipped(0);
    expect_measured(1);
}

TEST_F(BudgetOfRows, that_is_spent_estimates_no_more_rows)
{
    rows_.reserve(3);
    for (std::size_t row = 0; row < 3; ++row)
        add_row(Layout::tet80, 0.001, "other", 60); // drivers that compile at the first launch
    Budget limit = budget_of(100);
    limit.plan(rows_, 10);
    EXPECT_LT(now_s_ - 100, 3 * 60);
    EXPECT_NE(status_of(rows_[0]), status_of(rows_[1])) << "one is left";
    EXPECT_TRUE(contains(reason_of(rows_[2]), "was spent before this row was estimated")) << reason_of(rows_[2]);
}

TEST_F(BudgetOfRows, names_one_that_all_rows_fit_in)
{
    rows_.reserve(2);
    add_row(Layout::tet80, 1);
    add_row(Layout::tet96, 100);
    Budget small = budget_of(100);
    small.plan(rows_, 10);
    EXPECT_NE(reason_of(rows_[1]).find("with --budget 37m it"), std::string::npos) << reason_of(rows_[1]);
}

TEST_F(BudgetOfRows, a_first_launch_that_compiles_makes_no_row_slow_and_is_a_part_of_its_first_pass)
{
    rows_.reserve(1);
    add_row(Layout::tet80, 0.001, "other", 50);
    Budget limit = budget_of(100);
    static_cast<void>(run(limit));
    expect_measured(0);
    EXPECT_GE(traced(rows_[0])->wall_s, 50);
}

TEST_F(BudgetOfRows, a_row_that_becomes_slow_is_skipped_and_leaves_the_others_their_samples)
{
    rows_.reserve(2);
    add_row(Layout::tet80, 1);
    add_row(Layout::tet96, 1);
    Budget limit = budget_of(100);
    limit.plan(rows_, 10);
    *ray_s_[0] *= 20;
    verify_rows({&rows_[0], &rows_[1]}, scene_, options_, {}, {.budget = &limit});
    static_cast<void>(measure_rows(rows_, options_, read_benchmark_flags({}), limit));
    expect_skipped(0);
    expect_measured(1);
    EXPECT_GE(limit.left_s(), -25);
}

TEST_F(BudgetOfRows, openmps_rows_that_others_are_compared_with_are_never_skipped)
{
    rows_.reserve(3);
    const std::size_t reference = add_row(Layout::tet80, 5, "openmp"), compared = add_row(Layout::tet80, 4);
    const std::size_t alone = add_row(Layout::tet96, 3, "openmp");
    Budget limit = budget_of(100);
    limit.plan(rows_, 10);
    EXPECT_EQ(status_of(rows_[reference]), Status::ok);
    expect_skipped(compared);
    expect_skipped(alone);
}

TEST_F(BudgetOfRows, of_openmps_rows_that_do_not_fit_the_slowest_go_with_the_rows_that_are_compared_with_them)
{
    rows_.reserve(4);
    const std::size_t slow = add_row(Layout::tet80, 5, "openmp"), with_slow = add_row(Layout::tet80, 0.01);
    const std::size_t fast = add_row(Layout::tet96, 2, "openmp"), with_fast = add_row(Layout::tet96, 1);
    Budget limit = budget_of(100);
    static_cast<void>(run(limit));
    expect_skipped(slow);
    expect_skipped(with_slow);
    expect_measured(fast);
    expect_measured(with_fast);
}

TEST_F(BudgetOfRows, the_last_row_is_measured_although_it_does_not_fit)
{
    rows_.reserve(2);
    const std::size_t last = add_row(Layout::tet80, 10, "openmp"), other = add_row(Layout::tet80, 1);
    Budget limit = budget_of(100);
    static_cast<void>(run(limit));
    expect_measured(last);
    expect_skipped(other);
}

TEST_F(BudgetOfRows, keeps_of_each_structure_the_fastest_row_and_then_skips_the_last_scene)
{
    Options more = options_;
    SceneWork second{loaded_cubes(), more};
    rows_.reserve(8);
    for (std::size_t row = 0; row < 8; ++row) {
        add_row(Layout::tet80, std::vector<double>{2, 1, 4, 3}[row % 4]);
        rows_[row].key.kernel.structure = row % 4 < 2 ? Structure::cdt : Structure::bvh;
        if (row >= 4) rows_[row].scene = &second;
    }
    Budget limit =
        budget_of((1 + 3) * views_needed + 20 * views_estimated); // of the first scene, once all are estimated
    limit.plan(rows_, 10);
    for (const std::size_t row : {1, 3})
        EXPECT_EQ(status_of(rows_[row]), Status::ok) << reason_of(rows_[row]);
    for (const std::size_t row : {0, 2, 4, 5, 6, 7})
        expect_skipped(row);
}

TEST_F(BudgetOfRows, that_judging_takes_too_long_skips_as_many_rows_as_it_takes_too_long_for)
{
    rows_.reserve(4);
    for (std::size_t row = 0; row < 4; ++row)
        add_row(Layout::tet80, 0.001);
    Budget limit = budget_of(60);
    limit.plan(rows_, 10);
    now_s_ += 40;
    limit.judged(std::vector<const RowRun*>{&rows_[0], &rows_[1], &rows_[2], &rows_[3]}, 40);
    limit.review(); // 10 s more for each row; 20 s are left, and a quarter of 60
    EXPECT_EQ(std::ranges::count(rows_, Status::ok, [](const RowRun& row) { return status_of(row); }), 3);
}

TEST_F(BudgetOfRows, that_judging_takes_too_long_skips_whole_scenes_from_the_last_on)
{
    Options more = options_;
    SceneWork second{loaded_cubes(), more}, third{loaded_cubes(), more};
    rows_.reserve(3);
    for (std::size_t row = 0; row < 3; ++row)
        add_row(Layout::tet80, 0.1);
    rows_[1].scene = &second;
    rows_[2].scene = &third;
    Budget limit = budget_of(100);
    limit.plan(rows_, 10);
    const std::vector<const RowRun*> first = {&rows_[0]};
    limit.judged(first, 30); // so 150 s more for the other five views
    limit.review();
    EXPECT_EQ(status_of(rows_[0]), Status::ok) << reason_of(rows_[0]);
    EXPECT_EQ(status_of(rows_[1]), Status::ok) << reason_of(rows_[1]);
    expect_skipped(2);
    limit.judged(first, 1000);
    limit.review();
    expect_skipped(1);
    EXPECT_EQ(status_of(rows_[0]), Status::ok) << "the last scene stays";
}

TEST_F(BudgetOfRows, a_fast_rows_samples_take_their_own_time_however_slow_its_first_passes_were)
{
    rows_.reserve(1);
    add_row(Layout::tet80, 1e-3);
    Budget limit = budget_of(10); // five samples of a second, and their last passes
    limit.plan(rows_, 10, 1.0);
    EXPECT_EQ(status_of(rows_[0]), Status::ok) << reason_of(rows_[0]);
    limit.traced(rows_[0], 2, 0.04); // 20 times as long
    limit.review_timed();
    EXPECT_EQ(status_of(rows_[0]), Status::ok) << reason_of(rows_[0]);
}

TEST_F(BudgetOfRows, a_row_that_is_wrong_stays_wrong)
{
    rows_.reserve(2);
    add_row(Layout::tet80, 1);
    add_row(Layout::tet96, 1);
    Budget limit = budget_of(100);
    limit.plan(rows_, 10);
    std::get<Traced>(rows_[0].outcome).different = 1;
    limit.traced(rows_[0], 1, 100);
    limit.review();
    EXPECT_EQ(rows_[0].session, nullptr) << "nothing more is spent on it";
    EXPECT_EQ(status_of(rows_[0]), Status::wrong);
}

TEST_F(BudgetOfRows, without_a_limit_estimates_and_skips_nothing)
{
    rows_.reserve(1);
    add_row(Layout::tet80, 1e6);
    no_budget().plan(rows_, 10);
    EXPECT_EQ(now_s_, 100);
    EXPECT_EQ(run(no_budget()).samples, 10u);
}

TEST_F(BudgetOfRows, estimates_rays_that_are_given_from_a_part_of_them)
{
    rows_.reserve(1);
    RowKey key{"cubes", "openmp", {}, RayKind::random, TetOrder::chains};
    key.kernel.task = Task::rays;
    rows_.push_back(open_row(key, scene_, options_));
    const double ray_s = 1;
    rows_[0].session = std::make_unique<BudgetedSession>(std::move(rows_[0].session), now_s_, ray_s, 0);
    Budget limit = budget_of((views_needed + views_estimated) * view_rays);
    static_cast<void>(run(limit));
    expect_measured(0);
}

TEST_F(BudgetOfRows, estimates_rays_that_are_given_from_the_first_of_them_as_they_are)
{
    rows_.reserve(1);
    RowKey key{"cubes", "openmp", {}, RayKind::random, TetOrder::chains};
    key.kernel.task = Task::rays;
    rows_.push_back(open_row(key, scene_, options_));
    std::vector<Quad> some;
    rows_[0].session = std::make_unique<RaysKeptSession>(std::move(rows_[0].session), some);
    Budget limit = budget_of(1e9);
    limit.plan(rows_, 5);
    const auto& all = scene_.given_rays().rows(scene_, rows_[0].key, &rows_[0].packed->data, 0);
    const std::size_t rays = some.size() / GIVEN_RAY_QUADS;
    ASSERT_GT(rays, 0u);
    ASSERT_LT(some.size(), all.size());
    const auto is_same = [](const Quad& a, const Quad& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
    };
    EXPECT_TRUE(std::equal(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(rays), all.begin(), is_same));
    EXPECT_TRUE(std::equal(some.begin() + static_cast<std::ptrdiff_t>(rays), some.end(),
                           all.begin() + static_cast<std::ptrdiff_t>(all.size() / GIVEN_RAY_QUADS), is_same))
        << "the origins, after all directions";
}
