// What the compilers that are here make of the kernels. A compiler that is missing is a visible skip; what a version of
// a compiler makes of each program is in tests/expected/inspect-<compiler>.json, with its figures.
#include "tests/support/program_fixture.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

using namespace tetrace;
using namespace tetrace::test;
using nlohmann::json;

namespace {

class Inspect : public ProgramTest {
protected:
    /// The programs of a run that ends with that code, or with 3 if no target could be asked.
    json inspected(const std::string& arguments, int code = 0)
    {
        const Ended ended = run("inspect --out inspect.json " + arguments);
        const json result = json::parse(file("inspect.json"), nullptr, false);
        const json programs = result.is_discarded() ? json::array() : result["tetrace"]["programs"];
        const bool is_skipped = !programs.empty() && std::ranges::all_of(programs, [](const json& program) {
            return program["status"] == "skipped";
        });
        EXPECT_EQ(ended.code, is_skipped ? 3 : code) << ended.errors;
        return programs;
    }
};

/// An nvcc that is found before any other. Its programs are one instruction of PTX each.
class InspectedByStub : public Inspect {
protected:
    void SetUp() override { ::setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1); }
    void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }

    void install(const std::string& instruction)
    {
        const auto nvcc = folder_.path() / "nvcc";
        std::ofstream(nvcc) << fmt::format(stub, instruction);
        std::filesystem::permissions(nvcc, std::filesystem::perms::owner_all);
    }

private:
    static constexpr const char* stub = R"(#!/bin/sh
case $1 in
--version) echo 'Cuda compilation tools, release 0.0, V0.0.0' && exit ;;
--list-gpu-code) echo sm_90 && exit ;;
esac
while [ $# -gt 1 ]; do
    if [ "$1" = --keep-dir ]; then folder=$2; fi
    shift
done
kernel=$(basename "$1" .cu)
printf '.visible .entry %s(\n)\n{{\n\t%s\n\tret;\n}}\n' "trace_tiles_$kernel" '{}' > "$folder/$kernel.ptx"
echo "Compiling entry function 'trace_tiles_$kernel' for 'sm_90'" >&2
echo "0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads" >&2
echo "Used 32 registers" >&2
)";
    const std::string path_ = std::getenv("PATH");
};

/// A target's name as the name of a test may have it.
std::string test_name_of(std::string target)
{
    std::ranges::replace(target, ':', '_');
    return target;
}

/// A target, and the programs of which its compiler is asked here.
struct Asked {
    std::string target;
    std::vector<std::string> programs; ///< options of `inspect`
    bool are_all = true;               ///< all of the target that a version's file names
};

class InspectedTarget : public Inspect, public testing::WithParamInterface<Asked> {};

bool is_ok(const json& program)
{
    return program["status"] == "ok";
}

std::string name_of(const json& program)
{
    return program["target"].get<std::string>() + " " + program["method"].get<std::string>() + " " +
           program["layout"].get<std::string>() + " " + program["entry"].get<std::string>() +
           (program["schedule"] == "tiles" ? "" : " " + program["schedule"].get<std::string>());
}

/// The main entry of a kernel: primary rays from outside, one tile a group.
bool is_main(const json& program)
{
    return program["entry"] == "outside" && program["schedule"] == "tiles";
}

/// "radv-22.3", "nvcc-13.0".
std::string compiler_of(const json& program)
{
    std::smatch found;
    const auto text = program["compiler"].get<std::string>();
    if (std::regex_search(text, found, std::regex("^(radv|nvcc|hipcc)[^0-9]* ([0-9]+\\.[0-9]+)")))
        return found[1].str() + "-" + found[2].str();
    return text;
}

std::uint64_t count(const json& program, const char* key)
{
    return program.value(key, std::uint64_t{0});
}

bool spills(const json& program)
{
    return count(program, "spilled_registers") + count(program, "spill_store_bytes") +
               count(program, "spill_load_bytes") >
           0;
}

/// It spills nothing; a main entry keeps half of the occupancy.
bool is_as_wanted(const json& program)
{
    return !spills(program) &&
           (!is_main(program) || 2 * count(program, "subgroups") >= count(program, "most_subgroups"));
}

/// What nothing but the compiler changes.
json figures_of(const json& program)
{
    json figures;
    for (const char* const key : {"registers", "spilled_registers", "spill_store_bytes", "spill_load_bytes",
                                  "scratch_bytes", "subgroups", "most_subgroups", "fused"})
        if (program.contains(key)) figures[key] = program[key];
    return figures;
}

/// What is expected of a version of a compiler; null without a file.
json expected_of(const std::string& compiler)
{
    std::ifstream stream(std::filesystem::path(TETRACE_EXPECTED_FOLDER) / ("inspect-" + compiler + ".json"));
    return stream ? json::parse(stream) : json();
}

/// Programs and figures as the files have them, a line each.
std::string lines_of(const json& programs)
{
    std::string text;
    for (const auto& [name, figures] : programs.items())
        text += fmt::format("{}    \"{}\": {}", text.empty() ? "" : ",\n", name, figures.dump());
    return text + "\n";
}

/// The members of one target.
json of_target(const json& programs, const std::string& target)
{
    json some = json::object();
    for (const auto& [name, figures] : programs.items())
        if (name.starts_with(target + " ")) some[name] = figures;
    return some;
}

void expect_exact(const json& programs)
{
    for (const json& program : programs) {
        EXPECT_TRUE(is_ok(program)) << program;
        const std::string expected = program["structure"] == "cdt" ? "nothing" : "boxes";
        EXPECT_TRUE(program["fused_in"] == "nothing" || program["fused_in"] == expected) << program;
        EXPECT_TRUE(program.contains("fused")) << name_of(program) << ": its code was not seen";
    }
}

/// What the version's file says of the target is what was found, program by program. A program that the file does not
/// name is a visible skip. are_all: no program that the file names may be missing.
void expect_known_figures(const std::string& target, const json& programs, bool are_all)
{
    const std::string compiler = compiler_of(programs.front());
    const json known = expected_of(compiler);
    json exceptions = json::object(), figures = json::object();
    for (const json& program : programs) {
        figures[name_of(program)] = figures_of(program);
        if (!is_as_wanted(program)) exceptions[name_of(program)] = figures_of(program);
    }
    const auto named = [&](const json& all) {
        json some = json::object();
        const json of_it = of_target(all, target);
        for (const auto& [name, program] : of_it.items())
            if (are_all || figures.contains(name)) some[name] = program;
        return some;
    };
    if (!known.is_null()) {
        EXPECT_EQ(exceptions, named(known.at("exceptions"))) << "exceptions of " << compiler;
    }
    const json expected = known.is_null() ? json::object() : named(known.value("programs", json::object()));
    json unnamed = json::object();
    for (const auto& [name, found] : figures.items())
        if (!expected.contains(name)) unnamed[name] = found;
    std::string changes;
    for (const auto& [name, before] : expected.items())
        if (!figures.contains(name))
            changes += name + ": this program is missing\n";
        else if (figures[name] != before)
            changes += fmt::format("{}: {}, expected {}\n", name, figures[name].dump(), before.dump());
    const std::string where = fmt::format("\"programs\" of tests/expected/inspect-{}.json would have\n", compiler);
    EXPECT_TRUE(changes.empty()) << changes << where << lines_of(figures);
    if (!unnamed.empty())
        GTEST_SKIP() << (known.is_null() ? "nothing" : "no figure") << " is known of these programs by " << compiler
                     << (known.is_null() ? "" : ", only which are exceptions") << "; " << where << lines_of(unnamed);
}

} // namespace

// RADV takes 15 s of a core for the main entries of a target, and as long for all its other entries, nearly all of it
// for `project`; nvcc takes 20 s for all entries of a target.
INSTANTIATE_TEST_SUITE_P(
    each, InspectedTarget,
    testing::Values(Asked{"gfx1100",
                          {"--method all --entry outside",
                           "--method all --layout tet80,half32,bvh2,bvh4,cwbvh --entry "
                           "inside,rays",
                           "--method all --entry segments,tally,absorb"}},
                    Asked{"navi21", {"--method all --entry outside"}},
                    Asked{"gfx906", {"--method all --entry outside"}},
                    Asked{"sm_75", {"--method all --entry outside,inside,rays,segments,tally,absorb"}},
                    Asked{"sm_90",
                          {"--method project,single --layout half32,tet64,bvh2,bvh4,cwbvh --entry "
                           "outside,inside,rays,segments,tally,absorb"}},
                    Asked{"hip:gfx90a", {"--method project,single --layout half32,tet64,bvh2,bvh4,cwbvh"}},
                    Asked{"hip:gfx1100", {"--layout half32 --entry outside,rays"}}),
    [](const auto& instance) { return test_name_of(instance.param.target); });

// What a change of a kernel most often costs, in seconds: `each` is run by `make test-all`.
INSTANTIATE_TEST_SUITE_P(of_default_rows, InspectedTarget,
                         testing::Values(Asked{"navi21", {"--layout half32,bvh2,bvh4,cwbvh --entry outside"}, false}),
                         [](const auto& instance) { return instance.param.target; });

TEST_P(InspectedTarget, decides_nothing_by_fused_operations_spills_nothing_and_has_the_figures_of_its_compiler)
{
    const std::string target = GetParam().target;
    json programs = json::array();
    for (const std::string& some : GetParam().programs)
        for (const json& program : inspected("--target " + target + " " + some))
            programs.push_back(program);
    ASSERT_FALSE(programs.empty());
    if (programs.front()["status"] == "skipped") GTEST_SKIP() << programs.front()["reason"];
    expect_exact(programs);
    expect_known_figures(target, programs, GetParam().are_all);
}

TEST_F(Inspect, a_fast_kernel_is_fused_which_shows_that_the_search_sees_it)
{
    const json programs = inspected("--target gfx1100 --method maria --layout tet80 --math fast --entry outside");
    if (!programs.empty() && programs.front()["status"] == "skipped") GTEST_SKIP() << programs.front()["reason"];
    for (const json& program : programs) {
        EXPECT_EQ(program["fused_in"], "anything");
        EXPECT_GT(count(program, "fused"), 0u) << name_of(program);
        EXPECT_TRUE(program["first_fused"].get<std::string>().find("fma") != std::string::npos) << program;
    }
}

TEST_F(InspectedByStub, a_fused_operation_that_decides_is_reported_with_the_first_instruction_and_exit_code_1)
{
    install("fma.rn.f32 %f1, %f2, %f3, %f4;");
    const Ended walk = run("inspect --target sm_90 --method maria --layout tet80 --entry outside --schedule tiles");
    EXPECT_EQ(walk.code, 1) << walk.errors;
    EXPECT_NE(walk.out.find("DECISIONS: 1"), std::string::npos) << walk.out;
    EXPECT_NE(walk.out.find("1 fused operations decide signs; the first is 'fma.rn.f32 %f1, %f2, %f3, %f4;'"),
              std::string::npos)
        << walk.out;
    const json programs = inspected("--target sm_90 --method maria --layout tet80 --entry outside --schedule tiles", 1);
    ASSERT_EQ(programs.size(), 1u);
    EXPECT_EQ(programs[0]["fused_in"], "decisions");
    EXPECT_EQ(programs[0]["first_fused"], "fma.rn.f32 %f1, %f2, %f3, %f4;");
    const Ended fast = run("inspect --target sm_90 --method maria --layout tet80 --math fast --entry outside "
                           "--schedule tiles");
    EXPECT_EQ(fast.code, 0) << fast.out;
    EXPECT_NE(fast.out.find("free: 1"), std::string::npos) << fast.out;
}

TEST_F(InspectedByStub, a_bvh_may_fuse_what_states_its_rounding_and_nothing_else)
{
    const std::string bvh = "inspect --target sm_90 --layout bvh2 --entry outside --schedule tiles";
    install("fma.rn.f32 %f1, %f2, %f3, %f4;");
    const Ended stated = run(bvh);
    EXPECT_EQ(stated.code, 0) << stated.errors;
    EXPECT_NE(stated.out.find("boxes: 1"), std::string::npos) << stated.out;
    EXPECT_EQ(stated.out.find("DECISIONS"), std::string::npos) << stated.out;
    install("add.f32 %f1, %f2, %f3;");
    const Ended silent = run(bvh);
    EXPECT_EQ(silent.code, 1) << silent.errors;
    EXPECT_NE(silent.out.find("DECISIONS: 1"), std::string::npos) << silent.out;
}

TEST_F(Inspect, targets_that_cannot_be_asked_are_skipped_with_the_reason_and_fail_where_they_are_required)
{
    const json programs = inspected("--target gfx9999 --method maria --layout tet80");
    ASSERT_FALSE(programs.empty());
    for (const json& program : programs) {
        EXPECT_EQ(program["status"], "skipped");
        EXPECT_FALSE(program["reason"].get<std::string>().empty());
    }
    const Ended required = run("inspect --target gfx9999 --method maria --layout tet80 --require-target gfx9999");
    EXPECT_EQ(required.code, 3);
    EXPECT_NE(required.errors.find("--require-target gfx9999"), std::string::npos) << required.errors;
    EXPECT_EQ(run("inspect --target SM_90").code, 2);
    EXPECT_EQ(run("inspect --target gfx9999 --require-target sm_90 --method maria --layout tet80").code, 2);
}

TEST_F(Inspect, a_missing_hipcc_is_named_with_its_package)
{
    const std::string path = std::getenv("PATH");
    ::setenv("ROCM_PATH", "/nonexistent", 1);
    ::setenv("PATH", "/nonexistent", 1);
    const Ended ended = run("inspect --target hip:gfx90a --method maria --layout tet80");
    ::setenv("PATH", path.c_str(), 1);
    ::unsetenv("ROCM_PATH");
    EXPECT_EQ(ended.code, 3);
    EXPECT_NE(ended.out.find("hip:gfx90a: AMD's compiler of HIP, hipcc, is missing; install ROCm's (Debian: hipcc)"),
              std::string::npos)
        << ended.out << ended.errors;
}

TEST_F(Inspect, the_code_is_kept_where_it_is_asked_for)
{
    const json programs = inspected("--target gfx1100 --method maria --layout tet80 --entry outside --code code");
    if (!programs.empty() && programs.front()["status"] == "skipped") GTEST_SKIP() << programs.front()["reason"];
    EXPECT_NE(file("code/gfx1100-maria-tet80-exact-outside.s").find("s_endpgm"), std::string::npos);
}

TEST_F(Inspect, a_driver_of_this_machine_says_the_same_as_it_does_as_a_target)
{
    for (const char* const narrower : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) // RADV may not be among those
        ::unsetenv(narrower);
    ::setenv("RADV_FORCE_FAMILY", "navi21", 1);
    const json programs = inspected("--target navi21 --backend vulkan --device navi21 --method maria --layout tet80 "
                                    "--entry outside --code code");
    ::unsetenv("RADV_FORCE_FAMILY");
    if (programs.empty()) GTEST_SKIP() << "no RADV here; install mesa-vulkan-drivers";
    ASSERT_EQ(programs.size(), 2u) << programs;
    const json &target = programs[0], &driver = programs[1];
    ASSERT_EQ(driver["status"], "ok") << driver;
    EXPECT_TRUE(driver["target"].get<std::string>().starts_with("vulkan")) << driver;
    EXPECT_GT(count(driver, "registers"), 0u);
    for (const char* const key : {"registers", "spilled_registers", "scratch_bytes", "subgroups", "most_subgroups",
                                  "code_bytes", "instructions", "lanes", "compiler"})
        EXPECT_EQ(driver.value(key, json()), target.value(key, json())) << key;
    EXPECT_EQ(driver["statistics"]["VGPRs"], driver["registers"]);
    EXPECT_FALSE(driver.contains("fused")) << "its code is not searched";
    const std::string name = driver["target"].get<std::string>() + "-maria-tet80-exact-outside.s";
    EXPECT_NE(file(("code/" + name).c_str()).find("s_endpgm"), std::string::npos);
}

TEST_F(Inspect, a_driver_that_reports_nothing_is_skipped_with_the_reason)
{
    const Ended openmp = run("inspect --backend openmp --method maria --layout tet80");
    EXPECT_EQ(openmp.code, 3) << openmp.errors;
    EXPECT_NE(openmp.out.find("skipped: openmp: openmp reports nothing of its code"), std::string::npos) << openmp.out;
    const Ended host = run("inspect --backend cuda-host --method maria --layout tet80");
    EXPECT_EQ(host.code, 3) << host.errors;
    EXPECT_NE(host.out.find("does not report its code"), std::string::npos) << host.out;
    const Ended nobody = run("inspect --device no-such-device");
    EXPECT_EQ(nobody.code, 3);
    EXPECT_NE(nobody.errors.find("--device: no device has no-such-device"), std::string::npos) << nobody.errors;
    EXPECT_EQ(run("inspect --backend no-such-backend").code, 2);
}

TEST_F(Inspect, devices_are_required_by_their_labels)
{
    const std::string maria = " --method maria --layout tet80";
    const Ended required = run("inspect --backend cuda-host --require-target cuda-host" + maria);
    EXPECT_EQ(required.code, 3);
    EXPECT_NE(required.errors.find("--require-target cuda-host"), std::string::npos) << required.errors;
    EXPECT_EQ(run("inspect --backend openmp --require-target openmp:9" + maria).code, 2);
}

TEST_F(Inspect, a_backend_without_the_kernels_is_named)
{
    const std::string maria = " --method maria --layout tet80";
    const Ended none = run("inspect --backend embree" + maria);
    EXPECT_EQ(none.code, 2);
    EXPECT_NE(none.errors.find("--backend"), std::string::npos) << none.errors;
    const Ended some = run("inspect --backend embree,openmp" + maria);
    EXPECT_NE(some.out.find("embree: has none of these kernels"), std::string::npos) << some.out;
}

TEST_F(Inspect, opencl_says_what_it_knows_of_a_kernel)
{
    const json programs = inspected("--backend opencl --method maria --layout tet80 --schedule tiles --entry outside");
    if (programs.empty() || programs.front()["status"] == "skipped") GTEST_SKIP() << "no OpenCL device here";
    for (const json& program : programs) {
        EXPECT_EQ(program["status"], "ok") << program;
        EXPECT_GT(program["statistics"]["WORK_GROUP_SIZE"], 0) << program;
    }
}

TEST_F(Inspect, null_hardware_is_compile_only_and_nothing_is_run_on_it)
{
    for (const char* const narrower : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) // RADV may not be among those
        ::unsetenv(narrower);
    ::setenv("RADV_FORCE_FAMILY", "navi21", 1);
    const Ended devices = run("devices --format json");
    const Ended check = run("check --scene cubes --resolution 3 --size 8 --views 0 --method maria --backend vulkan");
    ::unsetenv("RADV_FORCE_FAMILY");
    ASSERT_EQ(devices.code, 0) << devices.errors;
    bool is_here = false;
    const json result = json::parse(devices.out);
    for (const json& device : result["tetrace"]["devices"])
        if (device["status"] == "compile only") {
            is_here = true;
            EXPECT_FALSE(device.contains("self_test")) << device;
            EXPECT_NE(device["reason"].get<std::string>().find("RADV_FORCE_FAMILY"), std::string::npos) << device;
        }
    if (!is_here) GTEST_SKIP() << "no RADV here; install mesa-vulkan-drivers";
    EXPECT_TRUE(check.code == 0 || check.code == 3) << check.errors;
    EXPECT_EQ(check.out.find("vkCreateFence"), std::string::npos) << check.out;
    EXPECT_EQ(check.out.find("Null hardware"), std::string::npos) << "it is without rows";
}
