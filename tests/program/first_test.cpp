#include "bench/terminal/text.h"
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The program of `make first`.
class First : public ProgramTest {};

} // namespace

TEST_F(First, has_the_rows_of_bench)
{
    const char* const list = "bench --list --scene cubes";
    const Ended first = run(list, TETRACE_FIRST), whole = run(list);
    EXPECT_EQ(first.code, 0) << first.errors;
    EXPECT_EQ(first.out, whole.out);
    EXPECT_TRUE(contains(first.out, "cdt/project/half32/cubes"));
}

TEST_F(First, measures_what_bench_does)
{
    const std::string command =
        "bench --backend openmp --scene cubes --resolution 6 --size 24 --samples 3 --sample-time 0 --out ";
    ASSERT_EQ(run(command + "first.json", TETRACE_FIRST).code, 0);
    ASSERT_EQ(run(command + "whole.json").code, 0);
    const auto rows_of = [&](const char* name) { return nlohmann::json::parse(file(name)).at("tetrace").at("rows"); };
    const auto first = rows_of("first.json"), whole = rows_of("whole.json");
    ASSERT_EQ(first.size(), whole.size());
    for (std::size_t row = 0; row < first.size(); ++row)
        EXPECT_EQ(first[row].at("hit_hash"), whole[row].at("hit_hash")) << first[row].at("name");
}

TEST_F(First, names_the_program_that_has_the_other_verbs)
{
    const Ended check = run("check --scene cubes", TETRACE_FIRST);
    EXPECT_EQ(check.code, 2);
    EXPECT_TRUE(contains(check.errors, "make build"));
    EXPECT_EQ(run("help bench", TETRACE_FIRST).code, 0);
}
