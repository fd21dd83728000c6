// Variants by the program: of right compilers all have the right hits; of a wrong one the smallest change that shows it
// is found, and written as a case.
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr const char* kernel = "--scene cubes --resolution 4 --size 24x16 --views 0 --method project --layout half32 ";

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

    [[nodiscard]] nlohmann::json variants() const
    {
        return nlohmann::json::parse(file("checked.json")).at("tetrace").at("variants");
    }
};

/// Leaves out what is in a loop of one round, if that counts steps in a walk.
constexpr const char* wrong_compiler =
    "sed -i '/variant_round/{N;/next.steps = at.steps/s/variant_round <= /variant_round + 1u <= /;}' \"$text\"\n"
    "exec \"$real\" \"$@\"";
constexpr const char* crashing_compiler =
    "if grep -q variant_round \"$text\"; then kill -SEGV $$; fi\nexec \"$real\" \"$@\"";

} // namespace

TEST_F(CheckVariants, of_opencl_and_vulkan_have_the_hits_of_the_kernel_as_it_is)
{
    const Ended ended = check("--variants 6");
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 0) << ended.out << ended.errors;
    for (const auto& row : variants().at("rows")) {
        EXPECT_EQ(row.at("ran"), 6) << row;
        EXPECT_GT(row.at("made"), 6) << row;
        EXPECT_TRUE(row.at("failures").empty()) << row;
    }
    EXPECT_TRUE(contains(file("checked.xml"), "variants/cdt/project/half32/cubes")) << file("checked.xml");
    const Ended shown = run("show checked.json");
    EXPECT_TRUE(contains(shown.out, "Conforms")) << shown.out << shown.errors;
}

TEST_F(CheckVariants, of_a_compiler_that_drops_a_loop_are_reduced_to_that_loop)
{
    const std::string arguments =
        "check --variants 8 --seed 8 --backend vulkan --out checked.json --junit checked.xml ";
    const Ended ended = check_with(wrong_compiler, arguments + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    std::string command;
    for (const auto& failure : variants().at("rows").at(0).at("failures")) {
        EXPECT_EQ(failure.at("outcome"), "wrong");
        ASSERT_EQ(failure.at("reduced").size(), 1u) << failure;
        const std::string change = failure.at("reduced").at(0);
        EXPECT_TRUE(change.starts_with("next_face") && change.ends_with("/round")) << change;
        command = failure.at("command");
    }
    ASSERT_FALSE(command.empty()) << ended.out;
    EXPECT_TRUE(contains(file("checked.xml"), "<failure")) << file("checked.xml");
    EXPECT_TRUE(contains(ended.out, "FAILED")) << ended.out;

    // The command writes the case with the same compiler's program, which is as wrong there; a right one's is right.
    const std::string dump = command.substr(std::string("tetrace ").size());
    if (std::system("command -v cc > /dev/null") != 0) GTEST_SKIP() << "no C compiler";
    const auto run_case = [&] {
        const int status =
            std::system(("cd '" + (folder_.path() / "case").string() +
                         "' && cc -O1 -o run_case run_case.c -l:libvulkan.so.1 && ./run_case > /dev/null")
                            .c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    };
    ASSERT_EQ(check_with(wrong_compiler, dump).code, 0);
    EXPECT_EQ(run_case(), 1);
    ASSERT_EQ(run(dump).code, 0);
    EXPECT_EQ(run_case(), 0);
}

TEST_F(CheckVariants, of_a_compiler_that_crashes_are_failures_and_not_the_end)
{
    const Ended ended =
        check_with(crashing_compiler, std::string("check --variants 8 --backend vulkan --out checked.json ") + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto row = variants().at("rows").at(0);
    EXPECT_EQ(row.at("ran"), 8);
    EXPECT_LT(row.at("failures").size(), 8u);
    for (const auto& failure : row.at("failures")) {
        EXPECT_EQ(failure.at("outcome"), "not compiled");
        EXPECT_EQ(failure.at("reduced").size(), 1u) << failure;
    }
}
