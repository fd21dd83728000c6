#include "bench/merging/scaling.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const std::vector<MeasuredScene> two_scenes = {{"a", 2, {1, 2, 3, 4, 5}}, {"b", 1, {10, 1}}};

ShardResult shard_with(std::vector<nlohmann::json> entries)
{
    ShardResult shard;
    shard.journal.entries = std::move(entries);
    return shard;
}

} // namespace

TEST(Scaling, one_rank_takes_the_sum_of_everything)
{
    const SimulatedRun run = simulate(two_scenes, 1);
    EXPECT_DOUBLE_EQ(run.seconds, 2 + 1 + 15 + 11);
    EXPECT_DOUBLE_EQ(run.open_s, 3);
    EXPECT_EQ(run.without, 0u);
}

TEST(Scaling, the_slowest_rank_ends_the_run)
{
    const SimulatedRun run = simulate(two_scenes, 2);
    EXPECT_DOUBLE_EQ(run.seconds, 3 + (1 + 3 + 5) + 10) << "parts are dealt out by number, not by time";
    EXPECT_DOUBLE_EQ(run.mean_s, (22.0 + (3 + 6 + 1)) / 2);
}

TEST(Scaling, ranks_without_a_part_do_nothing_and_open_nothing)
{
    const SimulatedRun run = simulate(two_scenes, 8);
    EXPECT_EQ(run.without, 3u);
    EXPECT_DOUBLE_EQ(run.seconds, 3 + 1 + 10) << "the first has a view of both";
}

TEST(Scaling, more_ranks_than_parts_gain_nothing)
{
    EXPECT_DOUBLE_EQ(simulate(two_scenes, 5).seconds, simulate(two_scenes, 1000).seconds);
}

TEST(Scaling, times_are_those_of_the_journals_of_all_shards)
{
    const auto scenes = measured_scenes(
        {shard_with({{{"scene", "a"}, {"view", 4}, {"wall_s", 3.0}, {"open_s", 1.0}}, {{"yardstick", "openmp:0"}}}),
         shard_with(
             {{{"scene", "a"}, {"view", 0}, {"wall_s", 5.0}, {"open_s", 2.0}}, {{"batch", 1}, {"wall_s", 7.0}}})});
    ASSERT_EQ(scenes.size(), 2u);
    EXPECT_EQ(scenes[0].name, "a");
    EXPECT_DOUBLE_EQ(scenes[0].open_s, 1.5);
    EXPECT_EQ(scenes[0].parts_s, (std::vector<double>{5, 3})) << "in the order of the whole run";
    EXPECT_EQ(scenes[1].parts_s, std::vector<double>{7});
}

TEST(Scaling, journals_without_times_are_refused)
{
    const auto scenes = measured_scenes({shard_with({{{"scene", "a"}, {"view", 4}}})});
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(scaling_sheet(scenes, {4}, 5)); }), "--ranks"));
}

TEST(Scaling, a_measured_view_stands_for_those_near_it)
{
    const auto all = of_all_views({{"a", 2, {1, 3}}, {"exit searches", 0, {7}, false}}, 5);
    EXPECT_EQ(all[0].parts_s, (std::vector<double>{1, 1, 1, 3, 3}));
    EXPECT_EQ(all[1].parts_s, std::vector<double>{7}) << "searches were all measured";
}

TEST(Scaling, the_sheet_says_where_the_end_is)
{
    const std::string text = scaling_sheet(two_scenes, {1, 2}, 5).markdown();
    EXPECT_TRUE(contains(text, "opening the scenes takes 3.0 s")) << text;
    EXPECT_TRUE(contains(text, "the longest part, of b, 10 s: no number of ranks")) << text;
}
