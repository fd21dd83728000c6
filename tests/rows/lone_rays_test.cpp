// What a step costs if one ray is traced by itself.
#include "bench/measuring/lone_rays.h"
#include "bench/measuring/view_recorder.h"
#include "tests/support/row_runs.h"
#include "tests/support/wrapped_session.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Notes how many rays each launch has. If asked for, the first hit of a launch of few rays is another.
class LoneSession : public WrappedSession {
public:
    LoneSession(std::unique_ptr<Session> inner, std::vector<std::size_t>& launched, const bool& changes)
        : WrappedSession(std::move(inner)), launched_(&launched), changes_(&changes)
    {
    }
    void start(std::span<const TraceJob> jobs) override
    {
        launched_->push_back(jobs.front().rays());
        WrappedSession::start(jobs);
    }

private:
    void change(std::span<Hit> hits) override
    {
        if (*changes_ && hits.size() <= 32) hits[0].t += 1;
    }

    std::vector<std::size_t>* launched_;
    const bool* changes_;
};

class LoneRays : public testing::Test {
protected:
    /// A verified row of random rays.
    RowRun open(KernelId kernel)
    {
        kernel.task = Task::rays;
        const RowKey key{"cubes", "openmp", kernel, RayKind::random, TetOrder::chains};
        RowRun row = open_row(key, scene_, options_);
        verify_rows({&row}, scene_, options_);
        row.session = std::make_unique<LoneSession>(std::move(row.session), launched_, changes_);
        row.views_of_rays.clear();
        return row;
    }

    Options options_ = parse_options({"bench", "--size", "64", "--views", "0", "--samples", "5", "--sample-time", "0"});
    SceneWork scene_{loaded_cubes(8), options_};
    std::vector<std::size_t> launched_;
    bool changes_ = false;
};

} // namespace

TEST_F(LoneRays, a_round_traces_all_rays_and_then_single_ones_in_launches_of_their_own)
{
    RowRun row = open({});
    StepCosts costs;
    measure_steps(row, costs, {}, 3, no_budget());
    ASSERT_NE(traced(row), nullptr) << reason_of(row);
    EXPECT_EQ(costs.steps, traced(row)->totals.steps());
    EXPECT_EQ(costs.alone_s.size(), 3u);
    ASSERT_EQ(launched_.size(), 1u + 3 * (1 + 64));
    EXPECT_EQ(launched_[1], 64u * 64) << "which fills the caches";
    EXPECT_EQ(std::ranges::count(launched_, 32u), 3 * 64) << "openmp's, of one thread";
}

TEST_F(LoneRays, of_a_bvh_steps_are_nodes)
{
    RowRun row = open({.structure = Structure::bvh, .method = Method::single, .layout = Layout::bvh2});
    const auto nodes = visited_nodes(row, 0);
    ASSERT_EQ(nodes.size(), 64u * 64);
    StepCosts costs;
    measure_steps(row, costs, nodes, 1, no_budget());
    EXPECT_EQ(costs.steps, traced(row)->visits.nodes);
    EXPECT_EQ(costs.alone_s.size(), 1u);
    EXPECT_TRUE(visited_nodes(open({}), 0).empty()) << "tets have none";
}

TEST_F(LoneRays, a_ray_with_another_hit_than_among_all_rays_ends_its_row)
{
    RowRun row = open({});
    changes_ = true;
    StepCosts costs;
    measure_steps(row, costs, {}, 1, no_budget());
    EXPECT_EQ(status_of(row), Status::error);
    EXPECT_NE(reason_of(row).find("another hit when it is traced alone"), std::string::npos) << reason_of(row);
    EXPECT_TRUE(costs.alone_s.empty());
    EXPECT_EQ(costs.steps, 0) << "only rows with answers have costs";
}

TEST(LoneRay, costs_the_slope_per_step_whatever_a_launch_costs_and_some_launches_were_disturbed)
{
    std::vector<LoneLaunch> launches;
    for (int i = 0; i < 64; ++i)
        launches.push_back({static_cast<double>(i), 5e-6 + 3e-9 * i + (i % 9 == 4 ? 1e-3 : 0)});
    const auto slope = slope_of(launches);
    ASSERT_TRUE(slope);
    EXPECT_NEAR(*slope, 3e-9, 3e-10);
    EXPECT_FALSE(slope_of({{4, 1e-6}, {4, 2e-6}})) << "all launches have equal steps";
    EXPECT_FALSE(slope_of({}));
}
