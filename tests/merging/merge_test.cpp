#include "tests/merging/merge_fixture.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const std::vector<const char*> answers = {"name", "status", "counts", "visits", "verification", "views_hash"};
const std::string scene = " --backend openmp,embree --scene cubes --resolution 6 --threads 1";
const std::string bench_job = "bench" + scene + " --size 24 --samples 5 --sample-time 0";
const std::string check_job = "check" + scene + " --size 16 --method all";

class Merge : public MergeTest {};

} // namespace

TEST_F(Merge, bench_has_the_counts_and_hashes_of_the_whole_run)
{
    ASSERT_EQ(run(bench_job + " --out whole.json").code, 0);
    const Ended ended = run("merge " + shards(bench_job, 3) + "--out all.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const Json whole = section("whole.json"), all = section("all.json");
    EXPECT_EQ(keys_of(all["rows"], answers), keys_of(whole["rows"], answers));
    EXPECT_EQ(all["scenes"][0]["views"], whole["scenes"][0]["views"]);
    EXPECT_EQ(all["merged"]["shards"], 3);
    EXPECT_FALSE(all.contains("shard"));
    EXPECT_FALSE(all["rows"][0].contains("hit_hash")) << "no shard knows it";
    EXPECT_TRUE(contains(ended.out, "merged of 3 shards")) << ended.out;
    EXPECT_EQ(run("show all.json").code, 0);
}

TEST_F(Merge, one_kind_of_machine_has_the_rates_of_its_summed_samples)
{
    ASSERT_EQ(run("merge " + shards(bench_job, 2) + "--out all.json").code, 0);
    const Json all = section("all.json");
    const auto samples = [&](const Json& result) { return result["rows"][0]["times"]["samples_s"]; };
    const Json first = samples(section("1.json")), second = samples(section("2.json"));
    ASSERT_EQ(samples(all).size(), 5u);
    EXPECT_DOUBLE_EQ(samples(all)[2].get<double>(), first[2].get<double>() + second[2].get<double>());
    ASSERT_EQ(all["merged"]["machines"].size(), 1u);
    EXPECT_EQ(all["merged"]["machines"][0]["shards"], Json({1, 2}));
}

TEST_F(Merge, a_row_is_as_noisy_as_the_noisiest_of_its_shards_and_has_the_fewest_samples)
{
    const std::string files = shards(bench_job, 2);
    const auto set = [](double pulse, const char* disturbed, std::size_t samples) {
        return [=](Json& section) {
            for (Json& row : section["rows"]) {
                if (row["status"] == "unsupported") continue; // Embree 4 lacks streams
                Json& times = row["times"];
                times["pulse"] = pulse;
                times.erase("disturbed");
                if (disturbed != nullptr) times["disturbed"] = disturbed;
                for (const char* key : {"samples_s", "wall_samples_s"}) {
                    Json fewer = Json::array();
                    for (std::size_t i = 0; i < samples; ++i)
                        fewer.push_back(times[key][i]);
                    times[key] = fewer;
                }
            }
        };
    };
    change("1.json", set(1, nullptr, 5));
    change("2.json", set(6, "the machine was elsewhere", 3));
    ASSERT_EQ(run("merge " + files + "--out all.json").code, 0);
    for (const Json& row : section("all.json")["rows"]) {
        if (row["status"] == "unsupported") continue;
        EXPECT_EQ(row["times"]["pulse"], 6);
        EXPECT_EQ(row["times"]["disturbed"], "the machine was elsewhere");
        EXPECT_EQ(row["times"]["noisy"], true);
        EXPECT_EQ(row["times"]["samples_s"].size(), 3u);
    }
}

TEST_F(Merge, a_run_of_which_no_row_could_run_exits_as_the_whole_run_would)
{
    const std::string files = shards(bench_job, 2);
    for (const char* name : {"1.json", "2.json"})
        change(name, [](Json& section) {
            for (Json& row : section["rows"]) {
                for (const char* key : {"counts", "visits", "verification", "hit_hash", "views_hash", "times", "rates"})
                    row.erase(key);
                row["status"] = "skipped";
                row["reason"] = "its device is elsewhere";
            }
        });
    const Ended ended = run("merge " + files + "--out all.json");
    EXPECT_EQ(ended.code, 3);
    EXPECT_TRUE(contains(ended.errors, "its device is elsewhere")) << ended.errors;
    EXPECT_EQ(section("all.json")["rows"][0]["status"], "skipped");
}

TEST_F(Merge, compare_takes_a_merged_result_for_the_same_work)
{
    ASSERT_EQ(run(bench_job + " --out whole.json").code, 0);
    ASSERT_EQ(run("merge " + shards(bench_job, 2) + "--out all.json").code, 0);
    const Ended ended = run("compare whole.json all.json --tolerance 100 --format json");
    const Json rows = Json::parse(ended.out)["tetrace"]["comparison"]["rows"];
    for (const Json& row : rows)
        EXPECT_NE(row["verdict"], "DIFFERENT") << row;
    change("all.json", [](Json& all) { all["rows"][0]["views_hash"] = "00000000000000ff"; });
    EXPECT_TRUE(contains(run("compare whole.json all.json").out, "DIFFERENT")) << "other answers are other work";
}

TEST_F(Merge, times_stay_with_their_machine)
{
    const std::string files = shards(bench_job, 2);
    change("2.json", [](Json& section) { section["host"]["cpu"] = "another"; });
    ASSERT_EQ(run("merge " + files + "--out all.json").code, 0);
    const Json all = section("all.json");
    for (const Json& row : all["rows"])
        EXPECT_FALSE(row.contains("rates") || row["times"].contains("samples_s")) << row["name"];
    ASSERT_EQ(all["merged"]["machines"].size(), 2u);
    for (const std::size_t i : {0u, 1u}) {
        const Json& machine = all["merged"]["machines"][i];
        const Json own = section(i == 0 ? "1.json" : "2.json");
        EXPECT_EQ(machine["host"]["cpu"], own["host"]["cpu"]);
        EXPECT_EQ(machine["rows"][0]["name"], own["rows"][0]["name"]);
        EXPECT_NEAR(machine["rows"][0]["mrays_per_s"].get<double>(),
                    own["rows"][0]["rates"]["mrays_per_s"].get<double>(), 1e-6);
    }
}

TEST_F(Merge, check_has_the_verdicts_and_the_exit_code_of_the_whole_run)
{
    const Ended whole = run(check_job + " --out whole.json");
    const Ended merged = run("merge " + shards(check_job, 4) + "--out all.json");
    EXPECT_EQ(merged.code, whole.code) << merged.errors;
    EXPECT_EQ(keys_of(section("all.json")["rows"], answers), keys_of(section("whole.json")["rows"], answers));
    Json matrix = section("whole.json")["matrix"];
    for (auto& [scene, rows] : matrix.items())
        for (auto& [row, devices] : rows.items())
            for (auto& [device, cell] : devices.items())
                cell.erase("hit_hash");
    EXPECT_EQ(section("all.json")["matrix"], matrix);
}

TEST_F(Merge, a_row_that_is_wrong_in_one_shard_is_wrong_and_exits_with_1)
{
    const std::string files = shards(check_job, 2);
    auto entries = entries_of(file("2.json.journal"));
    entries[1]["rows"].begin().value()["verdict"]["compared"] = {3, 3, 0};
    write_file(folder_ / "2.json.journal", journal_of(entries));
    const std::string row = entries[1]["rows"].begin().key();
    EXPECT_EQ(run("merge " + files + "--out all.json").code, 1);
    for (const Json& one : section("all.json")["rows"])
        EXPECT_EQ(one["status"] == "wrong", one["name"] == row) << one["name"];
}

TEST_F(Merge, a_missing_or_doubled_shard_is_refused_by_name)
{
    shards(bench_job, 3);
    EXPECT_TRUE(contains(refusal("1.json 3.json"), "shard is missing: 2/3"));
    EXPECT_TRUE(contains(refusal("2.json"), "shards are missing: 1/3, 3/3"));
    for (const char* ending : {".json", ".json.journal"})
        std::filesystem::copy_file(folder_ / (std::string("2") + ending), folder_ / (std::string("copy") + ending));
    EXPECT_TRUE(contains(refusal("1.json 2.json copy.json 3.json"), "shard 2/3 is doubled: '2.json' and 'copy.json'"));
}

TEST_F(Merge, shards_of_other_runs_are_refused_by_name)
{
    shards(bench_job, 2);
    const std::string second = file("2.json");
    const auto refused = [&](const std::function<void(Json&)>& changes) {
        write_file(folder_ / "2.json", second);
        change("2.json", changes);
        return refusal("1.json 2.json");
    };
    const auto commit = refused([](Json& section) { section["version"] = "9.9"; });
    EXPECT_TRUE(contains(commit, "another version: ") && contains(commit, "9.9 in shard 2/2 ('2.json')")) << commit;
    EXPECT_TRUE(contains(refused([](Json& section) { section["flags"] = "-Ofast"; }), "another flags"));
    EXPECT_TRUE(contains(refused([](Json& section) { section["scenes"][0]["hash"] = "00000000000000ff"; }),
                         "another scene cubes (its hash)"));
    EXPECT_TRUE(contains(refused([](Json& section) { section["shard"]["arguments"].push_back("--size"); }),
                         "another command line"));
    EXPECT_TRUE(contains(refused([](Json& section) { section["rows"].erase(0); }), "other rows: "));
    EXPECT_TRUE(contains(refused([](Json& section) { section.erase("shard"); }), "'2.json' is not a shard's result"));
    EXPECT_TRUE(contains(refused([](Json& section) { section["commit"] = "0000000"; }), "another commit: "));
}

TEST_F(Merge, a_journal_that_is_another_damaged_or_unfinished_is_refused)
{
    shards(bench_job, 2);
    const std::string journal = file("2.json.journal");
    write_file(folder_ / "2.json.journal", file("1.json.journal"));
    EXPECT_TRUE(contains(refusal("1.json 2.json"), "'2.json.journal' is not that of shard 2/2"));
    auto entries = entries_of(journal);
    entries.pop_back();
    write_file(folder_ / "2.json.journal", journal_of(entries));
    EXPECT_TRUE(contains(refusal("1.json 2.json"), "shard 2/2 ('2.json') did not end"));
    entries = entries_of(journal);
    entries.erase(entries.begin() + 1);
    write_file(folder_ / "2.json.journal", journal_of(entries));
    EXPECT_TRUE(contains(refusal("1.json 2.json"), "of cubes are in no journal"));
    std::string damaged = journal;
    damaged[damaged.size() / 2] ^= 1;
    write_file(folder_ / "2.json.journal", damaged);
    EXPECT_TRUE(contains(refusal("1.json 2.json"), "2.json.journal' is damaged"));
    std::filesystem::remove(folder_ / "2.json.journal");
    EXPECT_EQ(run("merge 1.json 2.json").code, 3);
}

TEST_F(Merge, a_shard_without_a_file_is_refused_before_it_runs)
{
    const Ended ended = run(bench_job + " --shard 1/2");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "name it with --out"));
}
