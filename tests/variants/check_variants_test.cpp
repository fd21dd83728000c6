// Variants by the program: of right compilers all have the right hits; of a wrong one the smallest change that shows it
// is found, and written as a case.
#include "bench/variants/variant_report.h"
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The kernel that is compiled fastest.
constexpr const char* kernel = "--scene cubes --resolution 4 --size 24x16 --views 0 --method maria --layout tet80 ";

class CheckVariants : public ProgramTest {
protected:
    /// With --out and --junit.
    Ended check(const std::string& arguments)
    {
        return run(std::string("check --out checked.json --junit checked.xml ") + kernel + arguments);
    }

    /// The same for Vulkan, with this as its glslangValidator. $text is the text's file, and $real its compiler.
    Ended check_with(const std::string& compiler, const std::string& arguments)
    {
        const auto folder = folder_.path() / "wrong";
        std::filesystem::create_directories(folder);
        const auto program = folder / "glslangValidator";
        write_file(program, "#!/bin/sh\nfor text; do :; done\nreal=$(PATH=${PATH#*:} command -v glslangValidator)\n" +
                                compiler + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        return run("PATH='" + folder.string() + ":'$PATH '" + TETRACE_PROGRAM + "' " + arguments, "/usr/bin/env");
    }

    [[nodiscard]] int run_case() const
    {
        const int status =
            std::system(("cd '" + (folder_.path() / "case").string() +
                         "' && cc -O1 -o run_case run_case.c -l:libvulkan.so.1 && ./run_case > /dev/null")
                            .c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    [[nodiscard]] nlohmann::json variants() const
    {
        return nlohmann::json::parse(file("checked.json")).at("tetrace").at("variants");
    }
};

// Seeds with variants that meet these, and few changes.
/// Drops the loop of one round round what a walk's step sets.
constexpr const char* wrong_compiler =
    "sed -i '/variant_round/{N;/ tet = half_face >> 2u/s/variant_round <= /variant_round + 1u <= /;}' \"$text\"\n"
    "exec \"$real\" \"$@\"";
constexpr const char* wrong_at = "--variants 2 --seed 7 ";
/// Ends at arguments in a struct, of one function.
constexpr const char* crashing_compiler =
    "if grep -q variant_of_other_face_all \"$text\"; then kill -SEGV $$; fi\nexec \"$real\" \"$@\"";
constexpr const char* crashing_at = "--variants 3 --seed 5 ";

} // namespace

TEST_F(CheckVariants, of_opencl_and_vulkan_have_the_hits_of_the_kernel_as_it_is)
{
    const Ended ended = check("--variants 3");
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 0) << ended.out << ended.errors;
    const auto found = variants();
    for (const auto& row : found.at("rows")) {
        EXPECT_EQ(row.at("ran"), 3) << row;
        EXPECT_GT(row.at("made"), 3) << row;
        EXPECT_TRUE(row.at("failures").empty()) << row;
    }
    EXPECT_TRUE(contains(file("checked.xml"), "variants/cdt/maria/tet80/cubes")) << file("checked.xml");
    const Ended shown = run("show checked.json");
    EXPECT_TRUE(contains(shown.out, "Conforms")) << shown.out << shown.errors;
}

TEST_F(CheckVariants, of_a_compiler_that_drops_a_loop_are_reduced_to_that_loop)
{
    const Ended ended =
        check_with(wrong_compiler,
                   std::string("check --backend vulkan --out checked.json --junit checked.xml ") + wrong_at + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto found = variants();
    const auto& failures = found.at("rows").at(0).at("failures");
    ASSERT_EQ(failures.size(), 1u) << ended.out;
    EXPECT_EQ(failures.at(0).at("outcome"), "wrong");
    ASSERT_EQ(failures.at(0).at("reduced").size(), 1u) << failures;
    const std::string change = failures.at(0).at("reduced").at(0);
    EXPECT_TRUE(change.starts_with("walk") && change.ends_with("/round")) << change;
    EXPECT_TRUE(contains(file("checked.xml"), "<failure")) << file("checked.xml");
    EXPECT_TRUE(contains(ended.out, "FAILED    1 of 2 variants")) << ended.out;

    // The command writes the case with the same compiler's program, which is as wrong there; a right one's is right.
    const std::string command = failures.at(0).at("command");
    const std::string dump = command.substr(std::string("tetrace ").size());
    if (std::system("command -v cc > /dev/null") != 0) GTEST_SKIP() << "no C compiler";
    ASSERT_EQ(check_with(wrong_compiler, dump).code, 0);
    EXPECT_EQ(run_case(), 1);
    ASSERT_EQ(run(dump).code, 0);
    EXPECT_EQ(run_case(), 0);
}

TEST_F(CheckVariants, of_a_compiler_that_crashes_are_failures_and_not_the_end)
{
    const Ended ended =
        check_with(crashing_compiler, std::string("check --backend vulkan --out checked.json ") + crashing_at + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto found = variants();
    const auto& row = found.at("rows").at(0);
    EXPECT_EQ(row.at("ran"), 3);
    ASSERT_EQ(row.at("failures").size(), 1u) << row;
    EXPECT_EQ(row.at("failures").at(0).at("outcome"), "not compiled");
    EXPECT_EQ(row.at("failures").at(0).at("reduced"), nlohmann::json({"other_face/struct"}));
}

TEST_F(CheckVariants, that_a_signal_ends_in_a_reduction_are_a_result)
{
    const std::string slow = "if grep -q variant_of_other_face_all \"$text\"; then\n"
                             "  echo x >> " +
                             (folder_.path() / "crashes").string() +
                             "\n"
                             "  if test $(wc -l < " +
                             (folder_.path() / "crashes").string() +
                             ") = 3; then kill -TERM $PPID; sleep 30; fi\n"
                             "  kill -SEGV $$\nfi\nexec \"$real\" \"$@\"";
    const Ended ended = check_with(slow, std::string("check --backend vulkan --out checked.json --junit checked.xml ") +
                                             crashing_at + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 130) << ended.out << ended.errors;
    const auto found = variants();
    const auto& failures = found.at("rows").at(0).at("failures");
    ASSERT_EQ(failures.size(), 1u) << failures;
    EXPECT_EQ(failures.at(0).at("unfinished"), true) << failures;
    EXPECT_TRUE(contains(ended.out, "reduced to fewer than ")) << ended.out;
    EXPECT_TRUE(contains(file("checked.xml"), "<failure")) << file("checked.xml");
}

TEST(VariantRows, whose_text_as_it_is_fails_fail_the_check)
{
    VariantRow right, failing;
    right.row.key.backend = failing.row.key.backend = "vulkan";
    right.ran = 2;
    failing.reason = "error with its text as it is: it hangs";
    EXPECT_EQ(exit_code({right, failing}), 0) << "skipped";
    failing.fails_as_it_is = true;
    EXPECT_EQ(exit_code({right, failing}), 1);
    EXPECT_TRUE(contains(variant_junit({right, failing}), "failures=\"1\""));
    const Report report = variant_report({right, failing}, {}, {}, {});
    EXPECT_TRUE(contains(report.sheet.text({}), "FAILED    1 of 3 variants")) << report.sheet.text({});
}
