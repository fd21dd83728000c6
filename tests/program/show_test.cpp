#include "tests/support/program_fixture.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

using namespace tetrace::test;

namespace {

/// `tetrace show`: results printed again, and several side by side.
class Show : public ProgramTest {
protected:
    /// What `show` prints after the line that names the run, and what the run printed without the line that names the
    /// file.
    static std::string without_head(const std::string& text) { return text.substr(text.find("\n\n") + 2); }
    static std::string without_result(const std::string& text)
    {
        return std::regex_replace(text, std::regex("Result    [^\n]*\n"), "");
    }

    void expect_the_same(const std::string& arguments)
    {
        const Ended first = run(arguments + " --out result.json");
        ASSERT_EQ(first.code, 0) << first.errors;
        const Ended again = run("show result.json");
        EXPECT_EQ(again.code, 0) << again.errors;
        EXPECT_EQ(without_head(again.out), without_result(first.out));
        EXPECT_TRUE(contains(again.out, arguments.substr(0, arguments.find(' ')))) << again.out;
    }

    const std::string tiny_ = " --scene cubes --resolution 4 --size 24 ";
};

} // namespace

TEST_F(Show, prints_what_bench_printed)
{
    expect_the_same("bench --samples 5 --sample-time 0 --backend openmp,embree,cuda-host" + tiny_);
}

TEST_F(Show, prints_what_bench_printed_of_given_rays_and_rows_that_did_not_run)
{
    expect_the_same(
        "bench --samples 3 --sample-time 0 --backend openmp,cuda-host --rays shadow,random --layout half32,bvh2" +
        tiny_);
}

TEST_F(Show, prints_what_check_printed)
{
    expect_the_same("check --backend openmp,embree,cuda-host" + tiny_);
}

TEST_F(Show, prints_what_reproduce_printed)
{
    expect_the_same("reproduce table3,table4,figure6 --backend openmp --views 0-1281:400" + tiny_);
}

TEST_F(Show, prints_whether_to_trust_what_reproduce_timed)
{
    const Ended first = run(
        "reproduce table3 --backend openmp --views 0-1281:400 --samples 3 --sample-time 0 --out result.json" + tiny_);
    ASSERT_EQ(first.code, 0) << first.errors;
    EXPECT_TRUE(contains(first.out, "Trust")) << first.out;
    EXPECT_TRUE(contains(first.out, "calibration of the host: ")) << first.out;
    EXPECT_EQ(without_head(run("show result.json").out), without_result(first.out));
}

TEST_F(Show, prints_what_trace_printed)
{
    const std::string ray = "trace --backend openmp,cuda-host --pixel 12,11 ";
    expect_the_same(ray + tiny_);
    expect_the_same(ray + "--rays ao --method project --view 2 " + tiny_);
    expect_the_same(ray + "--rays random --ray-order morton --layout tet96 " + tiny_);
    expect_the_same(ray + "--layout cwbvh " + tiny_);
}

TEST_F(Show, prints_what_check_printed_of_defects)
{
    expect_the_same("check --defects --backend openmp,cuda-host");
}

TEST_F(Show, is_ready_to_post_as_markdown_and_chooses_columns)
{
    have_measured("result.json");
    const std::string posted = run("show result.json --format markdown").out;
    EXPECT_TRUE(contains(posted, "### cubes: ")) << posted;
    EXPECT_TRUE(contains(posted, "| cdt maria tet80 | openmp | ")) << posted;
    EXPECT_TRUE(contains(posted, "\n- **Verified**: ")) << posted;
    const std::string narrow = run("show result.json --columns mrays_per_s,status").out;
    EXPECT_TRUE(contains(narrow, "Mrays/s  status")) << narrow;
    const Ended wrong = run("show result.json --columns speed");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_TRUE(contains(wrong.errors, "no table has the column 'speed'; accepted: row, backend, mrays_per_s"))
        << wrong.errors;
    EXPECT_EQ(bench("--columns speed").code, 2) << "before anything is measured";
}

TEST_F(Show, check_chooses_columns_too)
{
    const std::string check = "check --backend openmp --scene cubes --resolution 6 --size 24 ";
    const Ended chosen = run(check + "--columns openmp,wrong");
    EXPECT_EQ(chosen.code, 0) << chosen.errors;
    const std::string titles = std::regex_replace(chosen.out, std::regex(" +"), " ");
    EXPECT_TRUE(contains(titles, "row openmp\n")) << chosen.out;
    EXPECT_TRUE(contains(titles, "row wrong\n")) << chosen.out;
    EXPECT_TRUE(contains(run(check + "--columns wrong --format markdown").out, "| row | wrong |"));
    const Ended wrong = run(check + "--columns speed");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_TRUE(contains(wrong.errors, "no table has the column 'speed'; accepted: row, openmp, hits, rays"))
        << wrong.errors;
}

TEST_F(Show, names_the_verbs_whose_results_it_shows)
{
    ASSERT_EQ(run("scenes --out scenes.json").code, 0);
    const Ended scenes = run("show scenes.json");
    EXPECT_EQ(scenes.code, 2);
    EXPECT_TRUE(contains(scenes.errors, "results of bench, check, reproduce and trace")) << scenes.errors;
    EXPECT_EQ(run("show missing.json").code, 3);
}

TEST_F(Show, every_result_of_this_repository)
{
    for (const auto& entry : std::filesystem::recursive_directory_iterator(TETRACE_RESULTS)) {
        if (entry.path().extension() != ".json" || entry.path().filename() == "result.schema.json") continue;
        const Ended shown = run("show '" + entry.path().string() + "'");
        if (entry.path().parent_path().filename() == "compilers") { // of inspect
            EXPECT_EQ(shown.code, 2);
            EXPECT_TRUE(contains(shown.errors, "results of bench, check, reproduce and trace can be shown again"));
            continue;
        }
        EXPECT_EQ(shown.code, 0) << entry.path() << shown.errors;
        EXPECT_GT(shown.out.size(), 1000u) << entry.path();
    }
}

TEST_F(Show, writes_a_result_anew_value_for_value_in_less_space)
{
    const std::string old = TETRACE_RESULTS "/amd-epyc-zen3-2-cores/2026-11-21-afdb7f9.json";
    ASSERT_EQ(run("show " + old + " --out new.json").code, 0);
    const std::string text = file("new.json");
    EXPECT_EQ(nlohmann::json::parse(text), nlohmann::json::parse(read_text(old))) << "Google Benchmark's part included";
    EXPECT_LE(text.size(), std::filesystem::file_size(old));
}

TEST_F(Show, several_results_stand_side_by_side)
{
    have_measured("a.json", "--layout tet80,half32");
    auto other = nlohmann::json::parse(file("a.json"));
    other["tetrace"]["label"] = "b";
    write_file(folder_ / "b.json", other.dump());
    other["tetrace"]["rows"][0]["hit_hash"] = "0000000000000000";
    write_file(folder_ / "c.json", other.dump());
    const Ended ended = run("compare a.json b.json c.json --out all.json");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "on b,")) << ended.out;
    EXPECT_TRUE(contains(ended.out, " DIFFERENT\n")) << ended.out;
    EXPECT_TRUE(contains(ended.out, "DIFFERENT in C: hit hash")) << ended.out;
    EXPECT_TRUE(contains(ended.out, "C / A ")) << ended.out;
    EXPECT_EQ(nlohmann::json::parse(file("all.json"))["tetrace"]["comparisons"].size(), 2u);
}
