#include "tests/merging/merge_fixture.h"
#include "tests/reproduce/reproduce_fixture.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const std::vector<const char*> view_answers = {"name",   "status",       "reason",    "counts",
                                               "visits", "verification", "views_hash"};
const std::vector<const char*> search_answers = {"name", "status", "verification", "batches_hash"};

class MergeReproduce : public MergeTest {
protected:
    /// Of the tables, figures and claims, all that does not depend on times.
    static Json counted(const Json& section)
    {
        Json kept;
        for (const Json& table : section.at("tables"))
            if (table["id"] == "table4") kept["table4"] = {table["rows"], table["claims"], table["notes"]};
        for (const Json& figure : section.at("figures"))
            if (figure["id"] == "table4-views") kept["views"] = figure["series"];
        return kept;
    }
};

const std::string one_backend = " --backend openmp --scene cubes --resolution 6 --threads 1";

} // namespace

TEST_F(MergeReproduce, table4_by_four_shards_is_that_of_the_whole_run_in_every_count_and_hash)
{
    const std::string command = "reproduce table4 --layout tet80 --size 24 --views 0-1281:60" + one_backend;
    ASSERT_EQ(run(command + " --out whole.json").code, 0);
    const Ended ended = run("merge " + shards(command, 4) + "--out all.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const Json whole = section("whole.json"), all = section("all.json");
    EXPECT_EQ(keys_of(all["rows"], view_answers), keys_of(whole["rows"], view_answers));
    EXPECT_EQ(counted(all), counted(whole));
    ASSERT_FALSE(counted(all)["table4"].is_null());
    EXPECT_EQ(all["scenes"][0]["views"], whole["scenes"][0]["views"]);
    EXPECT_EQ(run("show all.json").code, 0);
}

TEST_F(MergeReproduce, shards_of_searches_have_other_batches_and_merge_to_all)
{
    const std::string command =
        "reproduce table5 --searches 60x64 --layout tet80 --samples 3 --sample-time 0 --backend openmp --threads 1";
    ASSERT_EQ(run(command + " --out whole.json").code, 0);
    ASSERT_EQ(run("merge " + shards(command, 3) + "--out all.json").code, 0);
    const Json whole = section("whole.json")["searches"], all = section("all.json")["searches"];
    EXPECT_EQ(keys_of(all["rows"], search_answers), keys_of(whole["rows"], search_answers));
    EXPECT_EQ(section("1.json")["searches"]["batches"], 7);
    EXPECT_EQ(all["batches"], 20);
    EXPECT_EQ(all["rows"][0]["batch_medians_s"].size(), 20u) << "one kind of machine: its times are put together";
}

TEST_F(MergeReproduce, rows_of_several_machines_keep_counts_and_lose_rates)
{
    const std::string command = "reproduce table3,table6 --layout tet80,bvh2 --method maria --size 16 --samples 3 "
                                "--sample-time 0.001 --views 0-1281:200" +
                                one_backend;
    ASSERT_EQ(run(command + " --out whole.json").code, 0);
    const std::string files = shards(command, 2);
    ASSERT_EQ(run("merge " + files + "--out one.json").code, 0);
    EXPECT_TRUE(section("one.json")["rows"][0].contains("rates"));
    EXPECT_GT(section("one.json")["rows"][0]["times"]["passes"], 1) << "tracing one view takes microseconds";
    change("2.json", [](Json& section) { section["label"] = "another"; });
    const Ended ended = run("merge " + files + "--out all.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const Json all = section("all.json");
    EXPECT_EQ(keys_of(all["rows"], view_answers), keys_of(section("whole.json")["rows"], view_answers));
    EXPECT_FALSE(all["rows"][0].contains("rates"));
    EXPECT_FALSE(all["rows"][0]["times"].contains("passes")) << "of samples that it has not";
    ASSERT_EQ(all["merged"]["machines"].size(), 2u);
    EXPECT_GT(all["merged"]["machines"][1]["rows"][0]["mrays_per_s"], 0);
}

TEST_F(MergeReproduce, a_scene_with_fewer_views_than_shards_is_in_some_of_them)
{
    const std::string command = "reproduce table4,table5 --layout tet80 --method maria --size 16 --views 0,700 "
                                "--searches 40x8 --samples 3 --sample-time 0" +
                                one_backend;
    ASSERT_EQ(run(command + " --out whole.json").code, 0);
    const Ended ended = run("merge " + shards(command, 3) + "--out all.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(section("3.json")["scenes"].empty());
    EXPECT_EQ(keys_of(section("all.json")["rows"], view_answers), keys_of(section("whole.json")["rows"], view_answers));
}

TEST_F(MergeReproduce, a_shard_without_anything_to_do_is_refused)
{
    const Ended ended =
        run("reproduce table4 --layout tet80 --size 16 --views 0 --shard 2/2 --out 2.json" + one_backend);
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "this shard would be empty")) << ended.errors;
}

class ResumedShard : public ReproduceTest {};

TEST_F(ResumedShard, a_shard_that_was_killed_is_resumed_and_merges)
{
    const std::string command = "table4 --method maria,ms06 --layout tet80 --size 48 --views 0-1281:20 ";
    ASSERT_EQ(run(command + "--out whole.json").code, 0);
    ASSERT_EQ(run(command + "--shard 1/2 --out 1.json").code, 0);
    const std::size_t views = kill_in_the_middle(command + "--shard 2/2 --out 2.json", "2.json.journal");
    ASSERT_LT(views, 32u);
    EXPECT_EQ(run(command + "--shard 1/2 --out 2.json --resume").code, 2) << "it is shard 2's journal";
    ASSERT_EQ(run(command + "--shard 2/2 --out 2.json --resume").code, 0);
    const std::string merge = fmt::format("cd '{0}' && XDG_CACHE_HOME='{0}/cache' '{1}' merge 2.json 1.json --out "
                                          "all.json > merged",
                                          folder_.path().string(), TETRACE_PROGRAM);
    ASSERT_EQ(std::system(merge.c_str()), 0);
    EXPECT_EQ(keys_of(result("all.json")["rows"], view_answers), keys_of(result("whole.json")["rows"], view_answers));
}
