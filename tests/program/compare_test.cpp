#include "tests/support/program_fixture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Json = nlohmann::json;

/// `tetrace compare` of results that `tetrace bench` made, changed here and there.
class Compare : public ProgramTest {
protected:
    /// What bench wrote, with seven samples per row that leave no doubt.
    Json result()
    {
        have_measured("measured.json", nine_rows);
        Json json = Json::parse(file("measured.json"));
        for (Json& row : json["tetrace"]["rows"]) {
            row["times"]["pulse"] = 1.0; // this machine may have been busy
            row["times"]["samples_s"] = {1.000, 1.001, 1.002, 1.003, 1.004, 1.005, 1.006};
        }
        return json;
    }

    void write(const char* name, const Json& json) { write_file(folder_ / name, json.dump()); }

    /// a.json as measured, b.json with a change.
    Ended compare_with(const std::function<void(Json& section)>& change, const std::string& options = {})
    {
        Json json = result();
        write("a.json", json);
        change(json["tetrace"]);
        write("b.json", json);
        return run("compare a.json b.json " + options);
    }

    /// What people read, with a blank where a line was broken.
    static std::string unwrapped(const Ended& ended) { return std::regex_replace(ended.out, std::regex("\\s+"), " "); }

    static void slow_down(Json& row, double factor)
    {
        for (Json& sample : row["times"]["samples_s"])
            sample = sample.get<double>() * factor;
    }
};

} // namespace

TEST_F(Compare, finds_a_result_the_same_as_itself)
{
    const Ended ended = compare_with([](Json&) {});
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(unwrapped(ended), "9 of 9 rows: 9 SAME; geometric mean of B / A 1.000"));
    EXPECT_TRUE(contains(unwrapped(ended), "Differ in nothing"));
    EXPECT_TRUE(contains(unwrapped(ended), "is at most 1 %"));
}

TEST_F(Compare, exits_with_1_on_a_regression_over_the_tolerance)
{
    const auto slower = [](Json& section) { slow_down(section["rows"][1], 1.05); };
    const Ended ended = compare_with(slower);
    EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.out, "SLOWER"));
    EXPECT_TRUE(contains(unwrapped(ended), "5.0 % slower, more than the tolerance of 3 %"));
    const Ended tolerant = compare_with(slower, "--tolerance 4.9");
    EXPECT_EQ(tolerant.code, 1) << tolerant.out;
    const Ended more_tolerant = compare_with(slower, "--tolerance 5.1%");
    EXPECT_EQ(more_tolerant.code, 0) << more_tolerant.out;
    EXPECT_FALSE(contains(more_tolerant.out, "Regressed"));
}

TEST_F(Compare, finds_an_improvement_without_complaint)
{
    const Ended ended = compare_with([](Json& section) { slow_down(section["rows"][0], 0.8); });
    EXPECT_EQ(ended.code, 0) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended), "1 FASTER"));
}

TEST_F(Compare, counts_a_failed_row_as_a_regression_and_a_missing_one_unless_allowed)
{
    const auto fail = [](Json& section) {
        section["rows"][0]["status"] = "error";
        section["rows"][0]["reason"] = "the driver is \x1b[31mgone";
    };
    const Ended failed = compare_with(fail, "--allow-missing");
    EXPECT_EQ(failed.code, 1) << failed.out;
    EXPECT_TRUE(contains(failed.out, "FAILED: B: error: the driver is ?[31mgone"));
    EXPECT_TRUE(contains(unwrapped(failed), "8 of 9 rows: 8 SAME"));
    const auto drop = [](Json& section) { section["rows"].erase(0); };
    EXPECT_EQ(compare_with(drop).code, 1);
    EXPECT_EQ(compare_with(drop, "--allow-missing").code, 0);
}

TEST_F(Compare, reports_what_else_differs)
{
    const Ended ended = compare_with([](Json& section) {
        section["commit"] = "fedcba9";
        section["rows"][0]["device"]["driver"] = "another driver";
    });
    EXPECT_TRUE(contains(unwrapped(ended), "the commit, devices or their drivers."));
    EXPECT_TRUE(contains(unwrapped(ended), "another driver in B"));
    EXPECT_TRUE(contains(unwrapped(ended), "(fedcba9)"));
}

TEST_F(Compare, calls_machines_by_their_labels)
{
    ASSERT_EQ(bench("--label 'Zen 3, 2 cores' --layout tet80 --out a.json").code, 0);
    Json other = Json::parse(file("a.json"));
    EXPECT_EQ(other["tetrace"]["label"], "Zen 3, 2 cores");
    other["tetrace"]["label"] = "Zen 5, 2 cores";
    write("b.json", other);
    const std::string told = unwrapped(run("compare a.json b.json"));
    EXPECT_TRUE(contains(told, "on Zen 3, 2 cores,")) << told;
    EXPECT_TRUE(contains(told, "openmp: Zen 3, 2 cores")) << told;
    EXPECT_TRUE(contains(told, "in A; Zen 5, 2 cores")) << told;
    EXPECT_EQ(bench("--label ''").code, 2);
}

TEST_F(Compare, reports_threads_compiler_flags_and_version)
{
    const Ended ended = compare_with([](Json& section) {
        section["version"] = "0.0.1";
        section["compiler"] = "another";
        section["flags"] = "-O0";
        section["threads"] = section["threads"].get<int>() + 1;
        section["host"].erase("threads");
    });
    EXPECT_TRUE(contains(unwrapped(ended),
                         "Differ in the version, the compiler, the compiler's flags, the threads that "
                         "the process may use, the threads that it used."))
        << ended.out;
}

TEST_F(Compare, reports_conditions_that_both_results_know)
{
    Json json = result();
    json["tetrace"]["conditions"] = {{"governor", "performance"}, {"turbo", true}};
    write("a.json", json);
    json["tetrace"]["conditions"] = {{"governor", "powersave"}, {"turbo", true}, {"smt", true}};
    write("b.json", json);
    const Ended ended = run("compare a.json b.json");
    EXPECT_TRUE(contains(unwrapped(ended), "Differ in the CPUs' frequency governor. ")) << ended.out;
}

TEST_F(Compare, says_so_where_samples_are_too_few_to_tell)
{
    const Ended ended = compare_with([](Json& section) {
        section["rows"][1]["times"]["samples_s"] = {10.00, 10.01, 10.02};
    });
    EXPECT_EQ(ended.code, 0);
    EXPECT_TRUE(contains(unwrapped(ended), "UNSURE: fewer than 5 samples, so no interval: 7 in A and 3 in B"));
    EXPECT_TRUE(contains(unwrapped(ended), "8 SAME, 1 UNSURE; 1 with fewer than 5 samples, so no interval;"));
}

TEST_F(Compare, a_run_of_a_disturbed_machine_is_not_judged_and_says_so)
{
    const Ended ended = compare_with([](Json& section) {
        slow_down(section["rows"][0], 6);
        section["rows"][0]["times"]["pulse"] = 6;
    });
    EXPECT_EQ(ended.code, 0) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended), "NOISY: in B calibration during its samples took 6.00 times its fastest"));
    EXPECT_TRUE(contains(unwrapped(ended), "8 SAME, 1 NOISY; geometric mean")) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended), "they decide nothing. Measure again on a quieter machine."));
}

TEST_F(Compare, chooses_columns_and_names_those_that_there_are)
{
    const Ended chosen = compare_with([](Json&) {}, "--columns verdict,after");
    EXPECT_EQ(chosen.code, 0) << chosen.errors;
    EXPECT_TRUE(contains(unwrapped(chosen), "row B verdict Mrays/s")) << chosen.out;
    EXPECT_TRUE(contains(run("compare a.json b.json --columns verdict --format markdown").out, "| row | verdict |"));
    const Ended wrong = run("compare a.json b.json --columns speed");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_TRUE(
        contains(wrong.errors, "no table has the column 'speed'; accepted: name, before, after, ratio, verdict"))
        << wrong.errors;
    const Ended several = run("compare a.json b.json a.json --columns C");
    EXPECT_EQ(several.code, 0) << several.errors;
    EXPECT_TRUE(contains(unwrapped(several), "row C Mrays/s (over A)")) << several.out;
}

TEST_F(Compare, has_an_interval_exactly_where_bench_has_one)
{
    const auto intervals = [&](const char* samples) {
        const std::string bench =
            "bench --backend openmp,cuda-host --layout half32 --scene cubes --resolution 3 --size 16 --sample-time 0 ";
        EXPECT_EQ(run(bench + "--samples " + samples + " --out a.json").code, 0);
        const Json ratio = Json::parse(file("a.json"))["tetrace"]["ratios"].at(0);
        EXPECT_LE(run("compare a.json a.json --out c.json").code, 1);
        const Json row = Json::parse(file("c.json"))["tetrace"]["comparison"]["rows"].at(0);
        return std::pair(ratio.contains("low"), row.contains("low"));
    };
    EXPECT_EQ(intervals("4"), std::pair(false, false));
    EXPECT_EQ(intervals("5"), std::pair(true, true));
}

TEST_F(Compare, compares_other_machines_in_what_did_the_same_work)
{
    const std::string results = TETRACE_RESULTS;
    const Ended ended = run("compare " + results + "/amd-epyc-zen3-2-cores/2026-11-21-afdb7f9.json " + results +
                            "/amd-epyc-zen5-2-cores/2026-11-22-7a91a68.json --out c.json");
    EXPECT_LE(ended.code, 1) << ended.errors;
    EXPECT_TRUE(contains(unwrapped(ended), "16 of 36 rows: ")) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended), "4 DIFFERENT, not compared")) << ended.out;
    for (const Json& row : Json::parse(file("c.json"))["tetrace"]["comparison"]["rows"])
        if (row["verdict"] == "DIFFERENT") {
            EXPECT_TRUE(contains(row["name"].get<std::string>(), "api:embree")) << row;
            EXPECT_TRUE(contains(row["note"].get<std::string>(), "hit hash")) << row;
        }
}

TEST_F(Compare, reads_results_of_table_5)
{
    const std::string result = TETRACE_RESULTS "/nvidia-h100-80gb/2026-11-23-47c6ed2-reproduce.json";
    const Ended ended = run("compare " + result + " " + result + " --filter ^search/ --tolerance 100");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "search/maria/tet80/random-tets/math:exact/api:cuda")) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended), "millions of searches per second")) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended), "geometric mean of B / A 1.000")) << ended.out;
}

TEST_F(Compare, never_replaces_what_it_compares)
{
    ASSERT_EQ(compare_with([](Json&) {}).code, 0);
    std::filesystem::create_symlink("b.json", folder_ / "link.json");
    const std::string before = file("a.json"), after = file("b.json");
    for (const char* const out : {"a.json", "./b.json", "link.json"}) {
        const Ended ended = run(std::string("compare a.json b.json --out ") + out);
        EXPECT_EQ(ended.code, 2) << out;
        EXPECT_TRUE(contains(ended.errors, "would replace the input")) << ended.errors;
    }
    EXPECT_EQ(file("a.json"), before);
    EXPECT_EQ(file("b.json"), after);
    EXPECT_EQ(run("report a.json --out a.json").code, 2);
    write_file(folder_ / "p.png", "a picture");
    EXPECT_EQ(run("report a.json --image p.png --out p.png").code, 2);
    EXPECT_EQ(file("a.json"), before);
    EXPECT_EQ(file("p.png"), "a picture");
    EXPECT_EQ(run("compare a.json b.json --out c.json").code, 0);
}

TEST_F(Compare, refuses_other_scenes_and_lists_other_hits_naming_the_row)
{
    const Ended tets = compare_with([](Json& section) { section["scenes"][0]["hash"] = "0000000000000000"; });
    EXPECT_EQ(tets.code, 0) << "rows of BVHs have the same triangles";
    EXPECT_TRUE(contains(unwrapped(tets), "4 of 9 rows: 4 SAME; 5 DIFFERENT, not compared")) << tets.out;
    const Ended scene = compare_with(
        [](Json& section) { section["scenes"][0]["hash"] = section["scenes"][0]["mesh_hash"] = "0000000000000000"; });
    EXPECT_EQ(scene.code, 2);
    EXPECT_EQ(scene.out, "");
    EXPECT_TRUE(contains(
        scene.errors, "5 rows, such as cdt/maria/tet80/cubes/primary/math:exact/api:openmp: the scene cubes has hash"));
    const Ended hits = compare_with([](Json& section) { section["rows"].back()["hit_hash"] = "0000000000000000"; });
    EXPECT_EQ(hits.code, 0) << hits.errors;
    EXPECT_TRUE(contains(hits.out, "api:embree: DIFFERENT: hit hash")) << hits.out;
    EXPECT_TRUE(contains(unwrapped(hits), "8 of 9 rows: 8 SAME; 1 DIFFERENT, not compared")) << hits.out;
}

TEST_F(Compare, gives_a_table_csv_markdown_and_json)
{
    const auto slower = [](Json& section) { slow_down(section["rows"][1], 1.25); };
    const Ended csv = compare_with(slower, "--format csv");
    EXPECT_EQ(csv.out.rfind("name,verdict,ratio,low,high,confidence,", 0), 0u);
    EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 10);
    EXPECT_TRUE(contains(compare_with(slower, "--format markdown").out,
                         "\n| row | A (Mrays/s) | B (Mrays/s) | B / A | verdict |\n"));
    const Ended both = compare_with(slower, "--out comparison.json");
    EXPECT_EQ(both.code, 1);
    EXPECT_TRUE(contains(both.out, "B / A"));
    const Json comparison = Json::parse(file("comparison.json"))["tetrace"]["comparison"];
    EXPECT_EQ(comparison["before"]["file"], "a.json");
    EXPECT_NEAR(comparison["rows"][1]["ratio"].get<double>(), 0.8, 1e-9);
    EXPECT_EQ(comparison["rows"][1]["verdict"], "SLOWER");
    ASSERT_EQ(comparison["regressions"].size(), 1u);
    EXPECT_EQ(comparison["regressions"][0], comparison["rows"][1]["name"]);
    EXPECT_NEAR(comparison["geometric_mean"].get<double>(), std::pow(0.8, 1.0 / 9), 1e-9);
}

TEST_F(Compare, refuses_files_that_it_cannot_compare)
{
    const Json measured = result();
    write("good.json", measured);
    const std::string good = file("good.json");
    write_file(folder_ / "text.json", "no json");
    write_file(folder_ / "cut.json", good.substr(0, good.size() / 2));
    Json newer = measured, empty = measured, no_samples = measured;
    newer["tetrace"]["schema_version"] = 3;
    empty["tetrace"]["rows"] = Json::array();
    for (Json& row : no_samples["tetrace"]["rows"])
        row["times"].erase("samples_s");
    write("newer.json", newer);
    write("empty.json", empty);
    write("no-samples.json", no_samples);
    ASSERT_EQ(run("check --scene cubes --resolution 6 --size 24 --backend openmp --out check.json").code, 0);
    for (const char* const bad :
         {"text.json", "cut.json", "newer.json", "empty.json", "no-samples.json", "check.json"}) {
        const Ended ended = run(std::string("compare ") + bad + " good.json");
        EXPECT_EQ(ended.code, 2) << bad << ": " << ended.out;
        EXPECT_EQ(ended.out, "") << bad;
        EXPECT_TRUE(contains(ended.errors, bad));
    }
    const Ended mixed = run("compare good.json check.json");
    EXPECT_EQ(mixed.code, 2);
    EXPECT_TRUE(contains(mixed.errors, "'check.json' is of 'tetrace check', which has verdicts and no times"))
        << mixed.errors;
    EXPECT_EQ(run("compare check.json check.json check.json").code, 2);
    EXPECT_EQ(run("compare check.json check.json --tolerance 5").code, 2);
    EXPECT_EQ(run("compare good.json none.json").code, 3);
}

TEST_F(Compare, of_two_checks_names_what_became_wrong_what_became_right_and_what_changed)
{
    const Ended checked =
        run("check --backend openmp,cuda-host --layout tet80,half32 --scene cubes --resolution 3 --size "
            "16 --views 0 --out a.json");
    ASSERT_EQ(checked.code, 0) << checked.errors;
    Json after = Json::parse(file("a.json"));
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < after["tetrace"]["rows"].size(); ++i)
        if (after["tetrace"]["rows"][i]["backend"] == "cuda-host") others.push_back(i);
    ASSERT_GE(others.size(), 2u);
    Json& wrong = after["tetrace"]["rows"][others[0]];
    wrong["status"] = "wrong";
    wrong["verification"]["different_from_openmp"] = 12;
    for (const std::size_t i : others)
        after["tetrace"]["rows"][i]["self_test"]["denormals_kept"] = false;
    write("b.json", after);
    const std::string row = wrong["name"];

    const Ended worse = run("compare a.json b.json --out c.json");
    EXPECT_EQ(worse.code, 1) << worse.out << worse.errors;
    EXPECT_TRUE(contains(unwrapped(worse), row + " bit-exact wrong: 12 rays BECAME WRONG")) << worse.out;
    EXPECT_TRUE(contains(unwrapped(worse), "self_test/denormals_kept on cuda-host true false CHANGED")) << worse.out;
    EXPECT_TRUE(contains(unwrapped(worse), "1 BECAME WRONG, 1 CHANGED, ")) << worse.out;
    const Json comparison = Json::parse(file("c.json"))["tetrace"]["check_comparison"];
    EXPECT_EQ(comparison["regressions"], Json({row}));
    const Ended better = run("compare b.json a.json");
    EXPECT_EQ(better.code, 0) << better.out;
    EXPECT_TRUE(contains(unwrapped(better), row + " wrong: 12 rays bit-exact BECAME RIGHT")) << better.out;
    EXPECT_EQ(run("compare b.json b.json").code, 0) << "what was wrong before is not a regression";

    after["tetrace"]["rows"].erase(others[0]);
    write("b.json", after);
    EXPECT_EQ(run("compare a.json b.json").code, 1) << "a row is missing";
    const Ended allowed = run("compare a.json b.json --allow-missing");
    EXPECT_EQ(allowed.code, 0) << allowed.out;
    EXPECT_TRUE(contains(unwrapped(allowed), row + ": B: no such row")) << allowed.out;
    EXPECT_EQ(run("compare b.json a.json").code, 0) << "a new row that is right";
    EXPECT_EQ(run("compare a.json b.json --filter none").code, 2);

    after["tetrace"]["scenes"][0]["width"] = 32;
    write("b.json", after);
    const Ended other_work = run("compare a.json b.json --allow-missing");
    EXPECT_EQ(other_work.code, 2) << other_work.out;
    EXPECT_TRUE(contains(other_work.errors, "measure B with --size 16x16")) << other_work.errors;
}

TEST_F(Compare, takes_two_files_and_more)
{
    for (const char* const bad : {"compare", "compare a.json", "compare a.json b.json --tolerance -1",
                                  "compare a.json b.json --tolerance x", "compare a.json b.json --samples 3"}) {
        const Ended ended = run(bad);
        EXPECT_EQ(ended.code, 2) << bad;
        EXPECT_NE(ended.errors, "") << bad;
    }
    EXPECT_TRUE(contains(run("compare a.json").errors, "usage: tetrace compare A.json B.json [C.json...] [OPTION]..."));
    EXPECT_TRUE(contains(run("help compare").out, "Usage: tetrace compare A.json B.json [C.json...] [OPTION]..."));
}
