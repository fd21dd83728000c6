#include "tests/support/program_fixture.h"

#include "core/device/defects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

struct CaseApi {
    const char *name, *loader;
};

/// A case is compiled and run as somebody does who does not have tetrace.
class Case : public ProgramTest, public testing::WithParamInterface<CaseApi> {
protected:
    [[nodiscard]] int shell(const std::string& command) const
    {
        const int status = std::system(("cd '" + folder_.path().string() + "' && " + command).c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    /// Why no case can be run here; empty if one can. Compiles a first case of each API.
    std::string why_no_host()
    {
        static std::map<std::string, std::string> reasons;
        const std::string api = GetParam().name;
        if (!reasons.contains(api)) reasons[api] = tried_host();
        return reasons.at(api);
    }

    std::string tried_host()
    {
        const Ended ended = dump("--defect value_after_divergent_loop");
        if (ended.code != 0) return ended.errors;
        if (shell("command -v cc > /dev/null") != 0) return "no C compiler";
        if (compile_case() == 0) return run_case() == 2 ? file("found.txt") : std::string();
        const std::string problem = file("cc.txt");
        if (contains(problem, "cannot find -l") || contains(problem, ".h: No such file")) return problem;
        ADD_FAILURE() << problem;
        return problem;
    }

    [[nodiscard]] int compile_case() const
    {
        return shell(std::string("cd case && cc -Wall -Werror -O1 -o run_case run_case.c -l:") + GetParam().loader +
                     " 2> ../cc.txt");
    }

    /// Runs the case; its output is in found.txt.
    [[nodiscard]] int run_case(const std::string& device = "") const
    {
        return shell("cd case && ./run_case '" + device + "' > ../found.txt 2>&1");
    }

    Ended dump(const std::string& arguments)
    {
        return run(std::string("dump --backend ") + GetParam().name + " " + arguments + " --out case");
    }
};

constexpr const char* tile = "--scene cubes --resolution 6 --size 24x20 --pixel 12,17 ";

} // namespace

TEST_P(Case, of_a_reduced_kernel_shows_the_defect_exactly_where_check_sees_it)
{
    if (const std::string reason = why_no_host(); !reason.empty()) GTEST_SKIP() << reason;
    const Ended check = run(std::string("check --defects --stress --format csv --backend ") + GetParam().name);
    for (const Defect& defect : all_defects()) {
        const std::string name(defect.name);
        std::string row = check.out.substr(check.out.find(name + ","));
        row.resize(row.find('\n'));
        const bool is_seen = row.starts_with(name + ",seen");
        if (name == "handed_over") continue; // a flake of lavapipe 22.3
        const std::set<std::string> examples = {"zoo_of_exits", "tallies_in_group", "words_past_64_mib",
                                                "words_at_the_end"};
        const bool is_example = examples.contains(name); // those that are right: a few
        if (defect.is_stressor && !is_seen && !is_example) continue;
        const auto launch = row.find(name + ":"); // the one that was wrong
        const auto end = row.find(')', launch);
        ASSERT_EQ(dump("--defect " + (launch == std::string::npos ? name : row.substr(launch, end - launch))).code, 0);
        ASSERT_EQ(compile_case(), 0) << file("cc.txt");
        EXPECT_EQ(run_case(), is_seen ? 1 : 0) << defect.name << file("found.txt") << check.out;
    }
}

TEST_P(Case, of_a_scene_gives_openmps_hits_for_tets_and_bvhs_and_all_kinds_of_rays)
{
    if (const std::string reason = why_no_host(); !reason.empty()) GTEST_SKIP() << reason;
    for (const std::string kernel :
         {"--method maria --layout tet80 --tile 8x4", "--layout bvh2 --rays diffuse",
          "--method project --layout half32 --domain wide --device emulated", "--layout cwbvh --device emulated",
          "--task segments --rays random", "--task tally --method project --layout tet64 --rays diffuse",
          "--task absorb --rays diffuse --ray-order shuffled --device emulated"}) {
        const Ended ended = dump(tile + kernel);
        if (ended.code == 3) continue; // no emulated device
        ASSERT_EQ(ended.code, 0) << ended.errors;
        EXPECT_EQ(ended.out, file("case/README.txt"));
        ASSERT_EQ(compile_case(), 0) << file("cc.txt");
        EXPECT_EQ(run_case(), 0) << kernel << file("found.txt");
    }
}

TEST_P(Case, names_the_first_word_that_is_not_the_expected_one)
{
    if (const std::string reason = why_no_host(); !reason.empty()) GTEST_SKIP() << reason;
    ASSERT_EQ(dump(tile).code, 0);
    ASSERT_EQ(compile_case(), 0) << file("cc.txt");
    std::string expected = file("case/expected.bin"), tolerance = file("case/tolerance.bin");
    const auto allowed = tolerance.find('\x03'); // t of the tile's first pixel
    ASSERT_NE(allowed, std::string::npos);
    expected[allowed] = static_cast<char>(expected[allowed] ^ 1);
    write_file(folder_ / "case/expected.bin", expected);
    EXPECT_EQ(run_case(), 0) << "within the tolerance" << file("found.txt");
    expected[allowed - 8] = static_cast<char>(expected[allowed - 8] ^ 1); // face_id
    write_file(folder_ / "case/expected.bin", expected);
    EXPECT_EQ(run_case(), 1);
    EXPECT_TRUE(contains(file("found.txt"), fmt::format("word {} is ", allowed / 4 - 2))) << file("found.txt");
    EXPECT_TRUE(contains(file("found.txt"), "1 of "));
    EXPECT_EQ(run_case("no such device"), 2) << file("found.txt");
    write_file(folder_ / "case/expected.bin", expected.substr(4));
    EXPECT_EQ(run_case(), 2) << "a file that is too short";
    std::filesystem::remove(folder_ / "case/tolerance.bin");
    EXPECT_EQ(run_case(), 2);
    EXPECT_TRUE(contains(file("found.txt"), "cannot read tolerance.bin")) << file("found.txt");
}

INSTANTIATE_TEST_SUITE_P(Apis, Case,
                         testing::Values(CaseApi{"opencl", "libOpenCL.so.1"}, CaseApi{"vulkan", "libvulkan.so.1"}),
                         [](const auto& api) { return std::string(api.param.name); });

using DumpedCases = ProgramTest;

TEST_F(DumpedCases, of_a_stressor_are_as_a_gpu_gets_it)
{
    const Ended ended = run("dump --backend opencl --defect denormals_in_minima --out case");
    if (ended.code == 2) GTEST_SKIP() << ended.errors; // a build without OpenCL
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(file("case/case.h"), "#define OPTIONS \""));
    EXPECT_FALSE(contains(file("case/case.h"), "-cl-denorms-are-zero")) << file("case/case.h");
}

TEST_F(DumpedCases, refuse_what_is_no_case)
{
    const std::string scene = "--scene cubes --resolution 6 --size 24 ";
    for (const std::string& arguments : std::vector<std::string>{
             "--backend cuda --defect loop_of_70000_iterations", "--backend openmp --pixel 1,1 " + scene,
             "--backend opencl --defect no_such_defect", "--backend opencl --defect zoo_of_exits:0:1",
             "--backend opencl --defect zoo_of_exits:64", "--backend opencl --defect zoo_of_exits:1000000:1",
             "--backend opencl --defect loop_of_70000_iterations:64:64",
             "--backend opencl --defect steps_of_nested_loops " + scene,
             "--backend opencl --defect steps_of_nested_loops --method maria", "--backend opencl --view 0",
             "--backend opencl --resolution 6", "--backend opencl " + scene, "--backend opencl --pixel 24,0 " + scene,
             "--backend opencl --math fast --pixel 1,1 " + scene,
             "--backend opencl --layout embree --pixel 1,1 " + scene}) {
        const Ended ended = run("dump --out out " + arguments);
        EXPECT_EQ(ended.code, 2) << arguments << ended.out << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "dump") || contains(ended.errors, "--")) << ended.errors;
        EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out")) << arguments;
    }
}
