// The program with drivers that misbehave: the rows of docs/faults.md.
#include "tests/support/program_fixture.h"

#include <csignal>
#include <iterator>
#include <regex>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class DriverFaults : public ProgramTest {
protected:
    /// Every driver of OpenCL is one that aborts when it is loaded.
    void break_opencl() const { write_file(folder_ / "vendors/broken.icd", TETRACE_ABORTING_DRIVER "\n"); }
    [[nodiscard]] std::string vendors() const { return (folder_ / "vendors").string(); }

    [[nodiscard]] bool has(const std::string& backend)
    {
        static std::map<std::string, bool> known;
        if (!known.contains(backend)) known[backend] = run("devices --require " + backend).code <= 1;
        return known[backend];
    }

    /// The verb on openmp and OpenCL, whose drivers misbehave.
    Ended run_faulty(const std::string& fault, const std::string& arguments)
    {
        const ScopedVariable faulty("FAULTY_OPENCL", fault);
        const ScopedVariable preload("LD_PRELOAD", TETRACE_FAULTY_OPENCL);
        return run(arguments + same_rows_);
    }

    /// With a blank where a line was broken.
    static std::string unwrapped(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }

    std::string same_rows_ = " --backend openmp,opencl --scene cubes --resolution 4 --size 24 --camera-set smoke "
                             "--threads 2 --method maria";
    std::string crash_ = "was ended by signal 6 (SIGABRT, Aborted) while ";
};

} // namespace

TEST_F(DriverFaults, opencl_that_crashes_at_load_is_named_and_vulkans_matrix_is_whole)
{
    if (!has("vulkan")) GTEST_SKIP() << "a Vulkan device is missing";
    const std::string check = "check --backend opencl,vulkan --scene cubes --resolution 4 --size 16 --camera-set smoke "
                              "--threads 2 --views 0 ";
    break_opencl();
    const ScopedVariable broken("OCL_ICD_VENDORS", vendors());
    const Ended ended = run(check + "--junit check.xml");
    EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.out, "the driver of opencl " + crash_ + "listing its devices"));
    EXPECT_TRUE(contains(ended.out, "bit-exact"));
    const std::string xml = file("check.xml");
    EXPECT_TRUE(contains(xml, "<error message=\"error: the driver of opencl was ended by signal 6"));
    const auto cases_of = [&](const std::string& part) {
        std::size_t count = 0;
        for (std::size_t at = 0; (at = xml.find(part, at)) != std::string::npos; ++at)
            ++count;
        return count;
    };
    EXPECT_EQ(cases_of("classname=\"tetrace.vulkan"), 7u);
    EXPECT_EQ(cases_of("<error "), cases_of("classname=\"tetrace.opencl"));
}

TEST_F(DriverFaults, devices_are_listed_next_to_a_driver_that_crashes_at_load)
{
    break_opencl();
    const ScopedVariable broken("OCL_ICD_VENDORS", vendors());
    const Ended ended = run("devices");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "openmp"));
    EXPECT_TRUE(contains(ended.out, "SIGABRT"));
    EXPECT_EQ(run("devices --require opencl").code, 3);
    EXPECT_EQ(run("devices --isolate none").code, 128 + SIGABRT); // and no list
}

#ifdef TETRACE_FAULTY_OPENCL
TEST_F(DriverFaults, required_device_whose_self_test_fails_is_exit_code_1)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    const ScopedVariable faulty("FAULTY_OPENCL", "build:1 abort"), preload("LD_PRELOAD", TETRACE_FAULTY_OPENCL);
    EXPECT_EQ(run("devices").code, 0);
    const Ended ended = run("devices --require openmp,opencl");
    EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "--require opencl: opencl is not exact: self-test: failed: ")) << ended.errors;
}

TEST_F(DriverFaults, driver_that_ends_at_any_call_ends_its_row_and_openmps_goes_on)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    const struct {
        const char *fault, *reason;
    } faults[] = {
        {"build:2 abort", "was ended by signal 6 (SIGABRT, Aborted) while opening cdt/maria/tet80"},
        {"launch:3 segv", "was ended by signal 11 (SIGSEGV, Segmentation fault) while launching"},
        {"launch:3 exit", "ended its process with exit code 7 while launching"},
        {"launch:3 kill", "was ended by signal 9 (SIGKILL, Killed), as the system does where memory is short"},
        {"read:2 abort", "was ended by signal 6 (SIGABRT, Aborted) while reading the hits"}};
    for (const auto& [fault, reason] : faults) {
        const Ended ended = run_faulty(fault, "check --views 0 --layout tet80");
        EXPECT_EQ(ended.code, 1) << fault << ended.out << ended.errors;
        EXPECT_TRUE(contains(ended.out, "the driver of opencl (")) << fault;
        EXPECT_TRUE(contains(ended.out, reason)) << fault << ended.errors;
        EXPECT_TRUE(contains(ended.out, "Verified  576 rays")) << fault; // openmp's
        EXPECT_TRUE(ended.out.ends_with("FAILED    1 of 2 rows, on opencl.\n")) << ended.out;
    }
}

TEST_F(DriverFaults, what_a_driver_reports_has_the_status_that_it_has_without_isolation)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    for (const char* fault : {"launch:3 out-of-memory", "launch:3 lost"}) {
        const Ended apart = run_faulty(fault, "check --views 0 --layout tet80");
        const Ended within = run_faulty(fault, "check --views 0 --layout tet80 --isolate none");
        EXPECT_EQ(apart.code, within.code) << fault;
        EXPECT_EQ(apart.out, within.out) << fault;
        EXPECT_TRUE(contains(apart.out, "CL_OUT_OF_")) << fault;
    }
}

TEST_F(DriverFaults, row_of_a_crash_is_the_only_one_that_fails)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    // The first process builds the self-test and a row; the second builds only the other row.
    const Ended ended = run_faulty("build:2 abort", "check --views 0 --layout tet80,tet96 --junit check.xml");
    EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
    const std::string xml = file("check.xml");
    EXPECT_TRUE(contains(xml, "errors=\"1\""));
    EXPECT_TRUE(contains(xml, "the driver of opencl"));
    EXPECT_TRUE(contains(xml, crash_ + "opening"));
}

TEST_F(DriverFaults, crash_in_the_middle_of_timing_costs_no_other_rows_samples)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    const Ended ended =
        run_faulty("launch:40 abort", "bench --samples 20 --sample-time 0 --layout tet80 --out bench.json");
    EXPECT_EQ(ended.code, 1) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.out, crash_ + "launching cdt/maria/tet80"));
    EXPECT_TRUE(contains(file("bench.json"), "\"samples_s\""));
}

TEST_F(DriverFaults, hang_ends_at_its_limit)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    const Ended ended = run_faulty("launch:3 hang", "check --views 0 --layout tet80 --driver-limit 15");
    EXPECT_EQ(ended.code, 1) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "gave no answer for 15 s, and was ended, while launching cdt/maria/tet80"));
}

TEST_F(DriverFaults, hang_of_a_stressor_is_its_rows_error_with_its_launch_and_the_next_ones_run)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    const ScopedVariable faulty("FAULTY_OPENCL", "launch:70 hang"); // the fifth of a stressor
    const ScopedVariable preload("LD_PRELOAD", TETRACE_FAULTY_OPENCL);
    const Ended ended = run("check --stress --backend opencl --driver-limit 15");
    EXPECT_EQ(ended.code, 1) << ended.errors;
    const std::string text = unwrapped(ended.out);
    EXPECT_TRUE(contains(text, "gave no answer for 15 s, and was ended, while running the reduced kernel")) << text;
    EXPECT_TRUE(std::regex_search(text, std::regex("\\(dump --defect [a-z_]+:1000000:128\\)"))) << text;
    // PoCL 6.0 does not compile one of these kernels, and crashes in another.
    const std::regex of_its_own("compiling defects with|was ended by signal");
    const auto own = std::distance(std::sregex_iterator(text.begin(), text.end(), of_its_own), std::sregex_iterator());
    EXPECT_TRUE(contains(text, " " + std::to_string(1 + own) + " errors")) << text;
}

TEST_F(DriverFaults, version_of_the_future_is_used_and_one_that_is_no_text_is_no_crash)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    for (const char* fault : {"version future", "version rubbish"}) {
        const Ended ended = run_faulty(fault, "check --views 0 --layout tet80");
        EXPECT_EQ(ended.code, 0) << fault << ended.out << ended.errors;
        EXPECT_TRUE(contains(ended.out, "bit-exact")) << fault;
    }
}

TEST_F(DriverFaults, garbage_and_nan_in_results_are_wrong)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    for (const char* fault : {"read:2 garbage", "read:2 nan"}) {
        const Ended ended = run_faulty(fault, "check --views 0 --layout tet80");
        EXPECT_EQ(ended.code, 1) << fault << ended.errors;
        EXPECT_TRUE(contains(ended.out, "wrong")) << fault;
    }
}

TEST_F(DriverFaults, known_failure_passes_and_its_absence_is_an_unexpected_pass)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    const std::string check = "check --views 0 --layout tet80 ", fault = "read:2 garbage";
    EXPECT_EQ(run_faulty(fault, check + "--write-expect known.json").code, 1);
    const Ended known = run_faulty(fault, check + "--expect known.json --junit check.xml");
    EXPECT_EQ(known.code, 0) << known.out << known.errors;
    EXPECT_TRUE(known.out.ends_with("Conforms  2 rows on 2 devices, 1 failure as expected.\n")) << known.out;
    EXPECT_TRUE(contains(file("check.xml"), "known failure: wrong")) << file("check.xml");
    EXPECT_FALSE(contains(file("check.xml"), "<failure"));

    const Ended passes = run_faulty("none", check + "--expect known.json --junit check.xml --out check.json");
    EXPECT_EQ(passes.code, 1) << passes.out << passes.errors;
    const std::string judged = "unexpected pass: expected wrong, shows bit-exact";
    const std::string verdict = "FAILED    1 unexpected pass in 2 rows on 2 devices.\n";
    EXPECT_TRUE(contains(unwrapped(passes.out), "cdt/maria/tet80/cubes/primary/math:exact/api:opencl: " + judged))
        << passes.out;
    EXPECT_TRUE(passes.out.ends_with(verdict)) << passes.out;
    EXPECT_TRUE(contains(file("check.xml"), "<failure message=\"" + judged)) << file("check.xml");
    const std::string shown = run("show check.json").out;
    EXPECT_TRUE(contains(unwrapped(shown), judged)) << shown;
    EXPECT_TRUE(shown.ends_with(verdict)) << shown;

    // Nothing of OpenCL is in a file that only has openmp.
    write_file(folder_ / "other.json", R"({"openmp": {"rows": {"tiles": "reference"}}})");
    const Ended other = run_faulty("none", check + "--expect other.json");
    EXPECT_EQ(other.code, 0) << other.out;
    EXPECT_TRUE(contains(other.out, "Unknown   no file of --expect mentions pocl-")) << other.out;
    EXPECT_EQ(run_faulty(fault, check + "--expect other.json").code, 1);
}

TEST_F(DriverFaults, failure_before_an_interrupt_counts_after_a_resume)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    ::signal(SIGINT, SIG_DFL); // a shell's background jobs ignore it, and so would the program
    const std::string check = "check --views 0 --layout tet80 --repeat 2 --out check.json ";
    {
        // After the head and a repetition.
        const ScopedVariable faulty("FAULTY_OPENCL", "launch:3 abort"), sync("TETRACE_KILLED_AT_SYNC", "2"),
            signal("TETRACE_SYNC_SIGNAL", std::to_string(SIGINT)),
            preload("LD_PRELOAD", TETRACE_FAULTY_OPENCL ":" TETRACE_KILLING_SYNC);
        const Ended ended = run(check + same_rows_);
        ASSERT_EQ(ended.code, 130) << ended.out << ended.errors;
    }
    const Ended resumed = run_faulty("none", check + "--resume");
    EXPECT_EQ(resumed.code, 1) << resumed.out << resumed.errors;
    EXPECT_TRUE(contains(resumed.out, "differs between repetitions: error in 1 of 2")) << resumed.out;
    EXPECT_TRUE(contains(resumed.out, "was ended by signal 6 (SIGABRT, Aborted) while launching")) << resumed.out;
    EXPECT_TRUE(contains(file("check.json"), R"("repeated":["error","bit-exact"])")) << file("check.json");
}

TEST_F(DriverFaults, failure_in_one_of_several_repetitions_is_a_flake_with_its_rate)
{
    if (!has("opencl")) GTEST_SKIP() << "an OpenCL device is missing";
    // The driver's process goes on from one repetition to the next, so its second read is in the first of them.
    const std::string check = "check --views 0 --layout tet80 --repeat 3 ", fault = "read:2 garbage";
    const Ended flaky = run_faulty(fault, check + "--write-expect known.json --out check.json --junit check.xml");
    EXPECT_EQ(flaky.code, 1) << flaky.out << flaky.errors;
    EXPECT_TRUE(contains(flaky.out, "api:opencl: differs between repetitions: wrong in 1 of 3")) << flaky.out;
    EXPECT_TRUE(contains(file("check.json"), R"("repeated":["wrong","bit-exact","bit-exact"])")) << file("check.json");
    EXPECT_TRUE(contains(file("check.xml"), "in 1 of 3")) << file("check.xml");
    EXPECT_TRUE(contains(run("show check.json").out, "differs between repetitions: wrong in 1 of 3"));
    const Ended known = run_faulty(fault, check + "--expect known.json");
    EXPECT_EQ(known.code, 0) << known.out << known.errors;
    EXPECT_TRUE(known.out.ends_with("Conforms  2 rows on 2 devices, 1 known flake.\n")) << known.out;
}
#endif
