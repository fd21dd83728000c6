// The program with Vulkan drivers that misbehave: rows of docs/faults.md.
#include "tests/support/program_fixture.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

class VulkanFaults : public ProgramTest {
protected:
    void SetUp() override
    {
        static const bool has_device = run("devices --require vulkan").code <= 1;
        if (!has_device) GTEST_SKIP() << "a Vulkan device is missing";
        write_file(folder_ / "layers/faulty.json",
                   R"({"file_format_version": "1.1.2", "layer": {"name": "VK_LAYER_TETRACE_faulty", "type": "GLOBAL",
                       "library_path": ")" TETRACE_FAULTY_VULKAN R"(", "api_version": "1.3.0",
                       "implementation_version": "1", "description": "misbehaves on demand"}})");
    }

    /// A verb while the drivers misbehave.
    Ended run_with(const std::string& fault, const std::string& arguments)
    {
        const ScopedVariable path("VK_LAYER_PATH", folder_ / "layers");
        const ScopedVariable layers("VK_INSTANCE_LAYERS", "VK_LAYER_TETRACE_faulty");
        const ScopedVariable faulty("FAULTY_VULKAN", fault);
        return run(arguments);
    }
    Ended check(const std::string& fault, const std::string& arguments = "--layout tet80")
    {
        return run_with(fault, "check --views 0 " + arguments + small_);
    }
    void expect_other_rows(const Ended& ended) const
    {
        EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
        EXPECT_TRUE(contains(ended.out, "Verified  576 rays")) << "openmp's";
    }

    std::string small_ =
        " --backend openmp,vulkan --scene cubes --resolution 4 --size 24 --camera-set smoke --threads 2 "
        "--method maria";
    std::string crash_ = "was ended by signal 6 (SIGABRT, Aborted) while ";
};

} // namespace

TEST_F(VulkanFaults, layer_that_does_nothing_changes_nothing)
{
    const Ended ended = check("none");
    EXPECT_EQ(ended.code, 0) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.out, "bit-exact"));
}

TEST_F(VulkanFaults, crash_at_load_is_named)
{
    const Ended ended = check("load abort");
    expect_other_rows(ended);
    EXPECT_TRUE(contains(ended.out, "the driver of vulkan " + crash_ + "listing its devices"));
}

TEST_F(VulkanFaults, driver_that_ends_at_any_call_ends_its_row_and_openmps_goes_on)
{
    const struct {
        const char *fault, *reason;
    } faults[] = {{"build:2 abort", "was ended by signal 6 (SIGABRT, Aborted) while opening cdt/maria/tet80"},
                  {"launch:2 segv", "was ended by signal 11 (SIGSEGV, Segmentation fault) while"},
                  {"wait:2 kill", "was ended by signal 9 (SIGKILL, Killed), as the system does where memory is short"}};
    for (const auto& [fault, reason] : faults) {
        const Ended ended = check(fault);
        expect_other_rows(ended);
        EXPECT_TRUE(contains(ended.out, "the driver of vulkan (")) << fault;
        EXPECT_TRUE(contains(ended.out, reason)) << fault << ended.errors;
    }
}

TEST_F(VulkanFaults, crash_in_the_middle_of_timing_costs_no_other_rows_samples)
{
    const Ended ended =
        run_with("launch:15 abort", "bench --views 0 --samples 20 --layout tet80 --out bench.json" + small_);
    EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.out, crash_ + "launching cdt/maria/tet80"));
    EXPECT_TRUE(contains(file("bench.json"), "\"samples_s\""));
}

TEST_F(VulkanFaults, hang_ends_at_its_limit)
{
    const Ended ended = check("wait:2 hang", "--layout tet80 --driver-limit 15");
    expect_other_rows(ended);
    EXPECT_TRUE(contains(ended.out, "gave no answer for 15 s, and was ended, while"));
}

TEST_F(VulkanFaults, garbage_and_nan_in_results_are_wrong)
{
    for (const char* fault : {"wait:3 garbage", "wait:3 nan"}) {
        const Ended ended = check(fault);
        expect_other_rows(ended);
        EXPECT_TRUE(contains(ended.out, "api:vulkan: wrong: ")) << fault;
    }
}

TEST_F(VulkanFaults, lost_device_is_an_error_and_short_memory_is_unsupported)
{
    const Ended lost = check("wait:3 lost");
    EXPECT_EQ(lost.code, 1) << lost.errors;
    EXPECT_TRUE(contains(lost.out, "api:vulkan: error: launching on"));
    EXPECT_TRUE(contains(lost.out, "ErrorDeviceLost"));
    const Ended ended = check("memory:5 out-of-memory");
    EXPECT_TRUE(contains(ended.out, "api:vulkan: unsupported: ")) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "ErrorOutOfDeviceMemory"));
}

TEST_F(VulkanFaults, version_of_the_future_is_used_and_one_of_the_past_refused)
{
    const Ended future = check("version future");
    EXPECT_EQ(future.code, 0) << future.out << future.errors;
    EXPECT_TRUE(contains(future.out, "bit-exact"));
    const Ended past = run_with("version past", "devices");
    EXPECT_TRUE(contains(past.out, "the driver offers Vulkan 1.0.0, 1.1 is needed"));
}

TEST_F(VulkanFaults, name_that_is_no_text_is_shown_as_question_marks)
{
    const Ended ended = run_with("version rubbish", "devices");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "????")) << ended.out;
}
