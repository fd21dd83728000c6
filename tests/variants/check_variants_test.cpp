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
    /// Runs the program with this as a compiler of that name, by default Vulkan's. $text is the text's file, and $real
    /// the compiler itself.
    Ended check_with(const std::string& compiler, const std::string& arguments,
                     const std::string& name = "glslangValidator")
    {
        const auto folder = folder_.path() / "wrong";
        std::filesystem::create_directories(folder);
        const auto program = folder / name;
        const std::string fast = name == "c++" ? "set -- \"$@\" -O0\n" : ""; // what it compiles is run for a moment
        write_file(program, "#!/bin/sh\nfor text; do :; done\nreal=$(PATH=${PATH#*:} command -v " + name + ")\n" +
                                fast + compiler + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        return run("CXX=c++ PATH='" + folder.string() + ":'$PATH '" + TETRACE_PROGRAM + "' " + arguments,
                   "/usr/bin/env");
    }

    /// The host of the case, compiled, and then what it says. That the C compiler fails is another matter.
    Ended run_case()
    {
        const Ended compiled = run("-c 'cd case && cc -O1 -o run_case run_case.c -l:libvulkan.so.1'", "/bin/sh");
        EXPECT_EQ(compiled.code, 0) << compiled.errors;
        return run("-c 'cd case && ./run_case'", "/bin/sh");
    }

    [[nodiscard]] nlohmann::json variants() const
    {
        return nlohmann::json::parse(file("checked.json")).at("tetrace").at("variants");
    }
};

// Seeds with variants that meet these, and few changes.
/// Drops the loop of one round round what a walk's step sets.
constexpr const char* wrong_compiler = "sed -i '/variant_round/{N;/ tet = half_face >> 2u\\| face = exit_face(\\| "
                                       "triangle = face_triangle(scene, tet, face/"
                                       "s/variant_round <= /variant_round + 1u <= /;}' \"$text\"\n"
                                       "exec \"$real\" \"$@\"";
constexpr const char* wrong_at = "--variants 2 --seed 7 ";
/// Ends at arguments in a struct, of one function.
constexpr const char* crashing_compiler =
    "if grep -q variant_of_other_face_all \"$text\"; then kill -SEGV $$; fi\nexec \"$real\" \"$@\"";
constexpr const char* crashing_at = "--variants 2 --seed 2 ";
constexpr const char* crashing_at_in_cuda = "--variants 2 --seed 26 "; // whose text has other changes
/// Its programs end the process at the same.
constexpr const char* trapping_compiler =
    "sed -i 's/    variant_of_other_face_all variant_all;/__builtin_trap(); &/' \"$text\"\nexec \"$real\" \"$@\"";
/// Its programs miscount the tets that a ray crosses if a function has its arguments in a struct: hits are right.
constexpr const char* miscounting_compiler = "if grep -q variant_of_other_face_all \"$text\"; then sed -i "
                                             "'s/all\\.crossings/(all.crossings + 1u)/' \"$text\"; fi\n"
                                             "exec \"$real\" \"$@\"";
/// Its code is one instruction, which fuses if a function has its arguments in a struct; then it spills, too.
constexpr const char* fusing_nvcc = R"(case $1 in
--version) echo 'Cuda compilation tools, release 0.0, V0.0.0' && exit ;;
--list-gpu-code) echo sm_90 && exit ;;
esac
while [ $# -gt 1 ]; do
    if [ "$1" = --keep-dir ]; then folder=$2; fi
    shift
done
kernel=$(basename "$text" .cu) instruction='add.rn.f32 %f1, %f2, %f3;' stores=0
if grep -q variant_of_other_face_all "$text"; then instruction='fma.rn.f32 %f1, %f2, %f3, %f4;' stores=8; fi
printf '.visible .entry %s(\n)\n{\n\t%s\n\tret;\n}\n' "trace_tiles_$kernel" "$instruction" > "$folder/$kernel.ptx"
echo "Compiling entry function 'trace_tiles_$kernel' for 'sm_90'" >&2
echo "0 bytes stack frame, $stores bytes spill stores, 0 bytes spill loads" >&2
echo "Used 32 registers" >&2)";

} // namespace

TEST_F(CheckVariants, of_every_api_have_the_hits_of_the_kernel_as_it_is)
{
    const Ended ended =
        check_with("exec \"$real\" \"$@\"",
                   std::string("check --out checked.json --junit checked.xml --variants 3 ") + kernel, "c++");
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
    const Ended wrong = run_case();
    EXPECT_EQ(wrong.code, 1) << wrong.out << wrong.errors;
    ASSERT_EQ(run(dump).code, 0);
    const Ended right = run_case();
    EXPECT_EQ(right.code, 0) << right.out << right.errors;
}

TEST_F(CheckVariants, of_a_compiler_that_crashes_are_failures_and_not_the_end)
{
    const Ended ended =
        check_with(crashing_compiler, std::string("check --backend vulkan --out checked.json ") + crashing_at + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto found = variants();
    const auto& row = found.at("rows").at(0);
    EXPECT_EQ(row.at("ran"), 2);
    ASSERT_EQ(row.at("failures").size(), 1u) << row;
    EXPECT_EQ(row.at("failures").at(0).at("outcome"), "not compiled");
    EXPECT_EQ(row.at("failures").at(0).at("reduced"), nlohmann::json({"other_face/struct"}));
}

TEST_F(CheckVariants, of_cuda_host_whose_programs_end_the_process_are_failures_and_their_text_is_written)
{
    const Ended ended =
        check_with(trapping_compiler,
                   std::string("check --backend cuda-host --out checked.json ") + crashing_at_in_cuda + kernel, "c++");
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto found = variants();
    const auto& row = found.at("rows").at(0);
    EXPECT_EQ(row.at("ran"), 2);
    ASSERT_EQ(row.at("failures").size(), 1u) << row;
    const auto& failure = row.at("failures").at(0);
    EXPECT_EQ(failure.at("outcome"), "not run");
    EXPECT_EQ(failure.at("reduced"), nlohmann::json({"other_face/struct"}));
    const std::string command = failure.at("command");
    ASSERT_EQ(run(command.substr(std::string("tetrace ").size())).code, 0) << command;
    const std::string text = file("case/maria_tet80_exact.cpp");
    EXPECT_TRUE(contains(text, "variant_of_other_face(variant_of_other_face_all variant_all)")) << command;

    const Ended missing =
        run("CXX=/no/compiler '" + std::string(TETRACE_PROGRAM) + "' check --backend cuda-host --variants 1 " + kernel,
            "/usr/bin/env");
    EXPECT_EQ(missing.code, 3) << missing.out;
    EXPECT_TRUE(contains(missing.out, "install g++")) << missing.out;
}

TEST_F(CheckVariants, of_another_task_are_written_as_a_case_of_it)
{
    const Ended ended = check_with(
        miscounting_compiler,
        std::string("check --backend vulkan --out checked.json --task tally --rays diffuse ") + crashing_at + kernel);
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto failure = variants().at("rows").at(0).at("failures").at(0);
    EXPECT_EQ(failure.at("outcome"), "wrong");
    EXPECT_EQ(failure.at("reduced"), nlohmann::json({"other_face/struct"}));
    const std::string command = failure.at("command");
    EXPECT_TRUE(contains(command, " --task tally --rays diffuse ")) << command;
    if (std::system("command -v cc > /dev/null") != 0) GTEST_SKIP() << "no C compiler";
    const std::string dump = command.substr(std::string("tetrace ").size());
    ASSERT_EQ(check_with(miscounting_compiler, dump).code, 0) << dump;
    const Ended wrong = run_case();
    EXPECT_EQ(wrong.code, 1) << wrong.out << wrong.errors;
    ASSERT_EQ(run(dump).code, 0);
    const Ended right = run_case();
    EXPECT_EQ(right.code, 0) << right.out << right.errors;
}

TEST_F(CheckVariants, of_another_task_on_cuda_host_name_its_entry_point)
{
    const Ended ended = check_with(miscounting_compiler,
                                   std::string("check --backend cuda-host --out checked.json --task segments ") +
                                       crashing_at_in_cuda + kernel,
                                   "c++");
    if (ended.code == 3) GTEST_SKIP() << ended.errors;
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const std::string command = variants().at("rows").at(0).at("failures").at(0).at("command");
    EXPECT_TRUE(contains(command, " --entry segments ")) << command;
    ASSERT_EQ(run(command.substr(std::string("tetrace ").size())).code, 0) << command;
    EXPECT_TRUE(contains(file("case/README.txt"), "is for all tets of given rays")) << file("case/README.txt");
}

TEST_F(CheckVariants, that_inspect_compiles_are_reduced_to_the_change_that_makes_the_compiler_fuse)
{
    const Ended ended = check_with(fusing_nvcc,
                                   std::string("inspect --target sm_90 --method maria --layout tet80 --entry outside "
                                               "--schedule tiles --out checked.json ") +
                                       crashing_at_in_cuda,
                                   "nvcc");
    ASSERT_EQ(ended.code, 1) << ended.out << ended.errors;
    const auto found = variants();
    const auto& row = found.at("rows").at(0);
    EXPECT_EQ(row.at("ran"), 2);
    EXPECT_EQ(row.at("spilling"), 1);
    ASSERT_EQ(row.at("failures").size(), 1u) << row;
    EXPECT_EQ(row.at("failures").at(0).at("outcome"), "fused");
    EXPECT_EQ(row.at("failures").at(0).at("reduced"), nlohmann::json({"other_face/struct"}));
    EXPECT_EQ(row.at("failures").at(0).at("command"),
              "tetrace dump --backend cuda --method maria --layout tet80 --variant other_face/struct --out case");
    EXPECT_TRUE(contains(ended.out, "FAILED    1 of 2 variants")) << ended.out;
    const Ended shown = run("show checked.json");
    EXPECT_TRUE(contains(shown.out, "1 with fused operations in decisions, 1 spilling")) << shown.out << shown.errors;
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
    EXPECT_TRUE(contains(ended.errors, "what ran by then is in 'checked.json'")) << ended.errors;
    const auto found = variants();
    const auto& failures = found.at("rows").at(0).at("failures");
    ASSERT_EQ(failures.size(), 1u) << failures;
    EXPECT_EQ(failures.at(0).at("unfinished"), true) << failures;
    EXPECT_TRUE(contains(ended.out, "reduced to fewer than ")) << ended.out;
    EXPECT_TRUE(contains(file("checked.xml"), "<failure")) << file("checked.xml");
}

TEST_F(CheckVariants, of_a_compiler_that_refuses_the_text_as_it_is_blame_no_change)
{
    const Ended refused = run(std::string("CXX=false '") + TETRACE_PROGRAM +
                                  "' check --backend cuda-host --variants 2 --scene cubes --resolution 4 --size 16 "
                                  "--views 0 --layout tet80 --method maria --out checked.json",
                              "/usr/bin/env");
    EXPECT_EQ(refused.code, 1) << refused.out << refused.errors;
    const auto row = variants().at("rows").at(0);
    EXPECT_TRUE(row.at("fails_as_it_is").get<bool>()) << row;
    EXPECT_TRUE(contains(row.at("reason").get<std::string>(), "not compiled with its text as it is")) << row;
    EXPECT_TRUE(!row.contains("failures") || row.at("failures").empty()) << row;
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
    EXPECT_TRUE(contains(report.sheet.text({}), "FAILED    1 of 3 programs")) << report.sheet.text({});
}
