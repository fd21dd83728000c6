// What the program says: each thing once, where it belongs.
#include "tests/support/program_fixture.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::size_t times_in(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

class Messages : public ProgramTest {
protected:
    /// A mesh that a builder finds to intersect itself, at length.
    void give_mesh_that_intersects_itself() const
    {
        write_file(folder_ / "knot.off", "OFF, as far as a shell script cares");
        write_file(folder_ / "builder", "#!/bin/sh\necho 'error: 7 pairs of triangles intersect' >&2\nexit 10\n");
        std::filesystem::permissions(folder_ / "builder", std::filesystem::perms::owner_all);
    }
};

} // namespace

TEST_F(Messages, a_mesh_that_intersects_itself_is_told_once_with_one_exit_code)
{
    give_mesh_that_intersects_itself();
    const ScopedVariable builder("TETRACE_BUILDER", folder_ / "builder");
    for (const char* const arguments : {"bench --backend openmp --scene knot.off", "check --backend openmp --scene knot.off",
                                        "build --scene knot.off", "build --scene knot.off --domain tight,tight",
                                        "render --scene knot.off"}) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 2) << arguments << ended.errors;
        EXPECT_EQ(times_in(ended.errors, "7 pairs of triangles"), 1u) << arguments << ended.errors;
        EXPECT_LE(times_in(ended.out, "7 pairs of triangles"), 1u) << arguments << ended.out;
        EXPECT_LT(ended.out.size(), 3000u) << arguments << ended.out;
    }
    const Ended json = run("bench --backend openmp --scene knot.off --format json");
    for (const auto& row : nlohmann::json::parse(json.out)["tetrace"]["rows"])
        EXPECT_TRUE(contains(row["reason"].get<std::string>(), "7 pairs of triangles")) << row;
}

TEST_F(Messages, a_reason_that_many_rows_share_is_one_line)
{
    const ScopedVariable none("CUDA_VISIBLE_DEVICES", "");
    const Ended ended = run("bench --backend openmp,cuda --scene cubes --resolution 3 --size 16 --samples 3");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(times_in(ended.out, ": skipped: "), 1u) << ended.out;
    EXPECT_TRUE(contains(ended.out, " rows of cubes, such as cdt/maria/tet80/cubes/primary/math:exact/api:cuda: skipped: "))
        << ended.out;
}

TEST_F(Messages, compare_says_of_many_rows_at_once_what_holds_of_all)
{
    ASSERT_EQ(bench("--out few.json").code, 0);
    ASSERT_EQ(bench("--layout tet80 --out one.json").code, 0);
    const Ended few = run("compare few.json few.json");
    EXPECT_EQ(times_in(few.out, "fewer than 5 samples, so no interval: 3 in A and 3 in B"), 1u) << few.out;
    const Ended missing = run("compare few.json one.json");
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(times_in(missing.out, "B: no such row"), 1u) << missing.out;
    EXPECT_EQ(times_in(missing.out, "Regressed"), 1u) << missing.out;
    EXPECT_TRUE(contains(missing.out, "7 rows are MISSING")) << missing.out;
}
