// What the compilers that are here make of the kernels. A compiler that is missing is a visible skip; what a version of
// a compiler is known to do worse than it should is in tests/expected/inspect-<compiler>.json, with its figures.
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
    /// The programs of a run that ends with that code.
    json inspected(const std::string& arguments, int code = 0)
    {
        const Ended ended = run("inspect --out inspect.json " + arguments);
        EXPECT_EQ(ended.code, code) << ended.errors;
        const json result = json::parse(file("inspect.json"), nullptr, false);
        if (result.is_discarded()) return json::array();
        return result["tetrace"]["programs"];
    }
};

bool is_ok(const json& program)
{
    return program["status"] == "ok";
}

std::string name_of(const json& program)
{
    return program["target"].get<std::string>() + " " + program["method"].get<std::string>() + " " +
           program["layout"].get<std::string>() + " " + program["entry"].get<std::string>();
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
    if (std::regex_search(text, found, std::regex("^(radv|nvcc)[^0-9]* ([0-9]+\\.[0-9]+)")))
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

/// Neither spilled nor below half of the occupancy.
bool is_as_wanted(const json& program)
{
    return !spills(program) && 2 * count(program, "subgroups") >= count(program, "most_subgroups");
}

/// The figures that an exception states.
json figures_of(const json& program)
{
    json figures;
    for (const char* const key : {"registers", "spilled_registers", "spill_store_bytes", "spill_load_bytes",
                                  "scratch_bytes", "subgroups", "most_subgroups"})
        if (program.contains(key)) figures[key] = program[key];
    return figures;
}

/// Empty where the compiler's version has no file.
json exceptions_of(const std::string& compiler)
{
    std::ifstream stream(std::filesystem::path(TETRACE_EXPECTED_FOLDER) / ("inspect-" + compiler + ".json"));
    return stream ? json::parse(stream)["exceptions"] : json();
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

/// What is worse than wanted is known of this version, with these figures; nothing is known that is not so.
void expect_known_figures(const json& programs)
{
    const std::string compiler = compiler_of(programs.front());
    const json known = exceptions_of(compiler);
    json found = json::object();
    for (const json& program : programs)
        if (is_main(program) && !is_as_wanted(program)) found[name_of(program)] = figures_of(program);
    if (known.is_null())
        GTEST_SKIP() << "nothing is known of " << compiler << "; tests/expected/inspect-" << compiler
                     << ".json would be\n"
                     << json{{"exceptions", found}}.dump(2);
    json selected = json::object();
    for (const auto& [name, figures] : known.items())
        if (std::ranges::any_of(programs, [&](const json& program) { return name_of(program) == name; }))
            selected[name] = figures;
    EXPECT_EQ(found, selected) << compiler;
}

} // namespace

TEST_F(Inspect, programs_of_amd_targets_decide_nothing_by_fused_operations_and_keep_half_of_the_occupancy)
{
    for (const char* const target : {"gfx1100", "gfx906"}) {
        const json programs = inspected(fmt::format(
            "--target {} --method maria,project,single --layout tet80,half32,tet64,bvh2,cwbvh --entry outside",
            target));
        ASSERT_FALSE(programs.empty());
        if (programs.front()["status"] == "skipped") GTEST_SKIP() << programs.front()["reason"];
        EXPECT_EQ(programs.size(), 6u) << "maria and project on tet80, project on half32 and tet64, two BVHs";
        expect_exact(programs);
        expect_known_figures(programs);
    }
}

TEST_F(Inspect, programs_of_nvidia_targets_decide_nothing_by_fused_operations_and_keep_half_of_the_occupancy)
{
    const json programs =
        inspected("--target sm_90 --method project,single --layout half32,tet64,bvh2,cwbvh --entry outside");
    if (!programs.empty() && programs.front()["status"] == "skipped") GTEST_SKIP() << programs.front()["reason"];
    EXPECT_EQ(programs.size(), 8u) << "tiles and persistent";
    expect_exact(programs);
    expect_known_figures(programs);
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

TEST_F(Inspect, targets_that_cannot_be_asked_are_skipped_with_the_reason_and_fail_where_they_are_required)
{
    const json programs = inspected("--target gfx9999 --method maria --layout tet80", 3);
    ASSERT_FALSE(programs.empty());
    for (const json& program : programs) {
        EXPECT_EQ(program["status"], "skipped");
        EXPECT_FALSE(program["reason"].get<std::string>().empty());
    }
    const Ended required = run("inspect --target gfx9999 --method maria --layout tet80 --require gfx9999");
    EXPECT_EQ(required.code, 3);
    EXPECT_NE(required.errors.find("--require gfx9999"), std::string::npos) << required.errors;
    EXPECT_EQ(run("inspect --target SM_90").code, 2);
    EXPECT_EQ(run("inspect --target gfx9999 --require sm_90 --method maria --layout tet80").code, 2);
}

TEST_F(Inspect, the_code_is_kept_where_it_is_asked_for)
{
    const json programs = inspected("--target gfx1100 --method maria --layout tet80 --entry outside --code code");
    if (!programs.empty() && programs.front()["status"] == "skipped") GTEST_SKIP() << programs.front()["reason"];
    EXPECT_NE(file("code/gfx1100-maria-tet80-exact-outside.s").find("s_endpgm"), std::string::npos);
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
    EXPECT_EQ(check.out.find("Null hardware"), std::string::npos) << "it has no rows";
}
