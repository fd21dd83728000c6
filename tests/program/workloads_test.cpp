// Named workloads, scores and one-screen tables; and that the example of docs/results.md works.
#include "scenes/catalogue.h"
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class WorkloadRuns : public ProgramTest {};

} // namespace

TEST_F(WorkloadRuns, exclude_the_options_that_a_workload_decides)
{
    const Ended twice = run("bench --workload default-2026.11 --size 64");
    EXPECT_EQ(twice.code, 2);
    EXPECT_TRUE(contains(twice.errors, "--size: --workload decides it, so that results compare")) << twice.errors;
    const Ended unknown = run("bench --workload default-2025.01");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_TRUE(contains(unknown.errors, "Accepted: default-2026.11 or score-2026.11")) << unknown.errors;
    const Ended listed = run("bench --workload score-2026.11 --layout half32 --schedule tiles --backend openmp --list");
    EXPECT_EQ(listed.code, 0) << listed.errors;
    EXPECT_EQ(std::ranges::count(listed.out, '\n'), 9) << "three scenes, three kinds of rays:\n" << listed.out;
}

TEST_F(WorkloadRuns, are_not_what_another_scene_runs)
{
    const Ended ended = bench("--layout half32 --brief --out result.json");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "Score     none: the run is not of a named workload")) << ended.out;
    EXPECT_TRUE(contains(ended.out, "Machine   "));
    const auto section = nlohmann::json::parse(file("result.json")).at("tetrace");
    EXPECT_FALSE(section.contains("workload") || section.contains("scores"));
    EXPECT_FALSE(section.at("scenes")[0].contains("pinned"));
    EXPECT_TRUE(section.at("scenes")[0].contains("mesh_hash"));
}

// The page says: measure with the defaults, then compare with this result of another machine and version.
TEST_F(WorkloadRuns, compare_with_the_result_that_the_documentation_names)
{
    if (!why_not_available("bunny-1").empty()) GTEST_SKIP() << why_not_available("bunny-1");
    const std::string page = read_text(TETRACE_DOCS "/results.md");
    std::smatch found, measure;
    ASSERT_TRUE(std::regex_search(page, found, std::regex("tetrace compare (results/[^ ]+) result.json")));
    ASSERT_TRUE(std::regex_search(page, measure, std::regex("tetrace (bench .*--out result.json)")));
    // One of the rows that this measures.
    const Ended measured = run(measure[1].str() + " --filter '^cdt/project/half32/bunny/.*openmp$' --schedule tiles");
    ASSERT_EQ(measured.code, 0) << measured.errors;
    EXPECT_EQ(nlohmann::json::parse(file("result.json")).at("tetrace").at("scenes")[0].at("pinned"), "bunny-1");
    const Ended compared = run("compare " TETRACE_ROOT "/" + found[1].str() +
                               " result.json --filter "
                               "'^cdt/project/half32/bunny/primary/math:exact/api:openmp$'");
    EXPECT_LE(compared.code, 1) << "faster or slower than that machine\n" << compared.out << compared.errors;
    EXPECT_TRUE(contains(compared.out, "Compared  1 of 1 rows")) << compared.out;
    EXPECT_FALSE(contains(compared.out, "DIFFERENT")) << compared.out;
}
