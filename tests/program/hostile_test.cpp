// Names, options and drivers as nobody would wish them.
#include "core/base/printable.h"
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "tests/support/program_fixture.h"

#include <nlohmann/json.hpp>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class Hostile : public ProgramTest {
protected:
    /// Has every driver of OpenCL and Vulkan be one that aborts.
    void break_drivers() const
    {
        const std::string driver = TETRACE_ABORTING_DRIVER;
        write_file(folder_ / "vendors/broken.icd", driver + "\n");
        write_file(folder_ / "broken.json", R"({"file_format_version": "1.0.0", "ICD": {"library_path": ")" + driver +
                                                R"(", "api_version": "1.1.0"}})");
    }

    std::string name_ = "caf\xe9 \x1b[2J\n=\xe2\x80\xae";
    std::string shown_ = "caf? ?[2J?=?";
};

void expect_printable(const std::string& text)
{
    EXPECT_EQ(printable_text(text), text);
}

} // namespace

TEST_F(Hostile, a_name_that_is_not_utf_8_and_has_escapes_costs_no_result)
{
    write_scene(folder_ / (name_ + ".tet"), make_cubes(3));
    const std::string bench =
        "bench --backend openmp --layout tet80 --size 16 --samples 3 --sample-time 0 --scene '" + name_ + ".tet' ";
    const Ended ended = run(bench + "--out a.json --benchmark_out=gb.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    expect_printable(ended.out + ended.errors);
    EXPECT_TRUE(contains(ended.out, shown_)) << ended.out;
    const auto rows = nlohmann::json::parse(file("a.json"))["tetrace"]["rows"];
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(rows[0]["scene"], shown_);
    EXPECT_FALSE(nlohmann::json::parse(file("gb.json"))["benchmarks"].empty());
    expect_printable(run(bench + "--format csv").out);
    expect_printable(run(bench + "--benchmark_format=console").out);
    EXPECT_EQ(run("compare a.json a.json").code, 0) << "it is read again";

    const Ended check =
        run("check --backend openmp --layout tet80 --size 16 --scene '" + name_ + ".tet' --out b.json --junit b.xml");
    EXPECT_EQ(check.code, 0) << check.errors;
    expect_printable(check.out + check.errors + file("b.xml"));
}

TEST_F(Hostile, no_escape_of_an_option_or_of_a_file_reaches_the_terminal)
{
    const std::string escape = "\x1b]0;x\x07\xff";
    for (const std::string& arguments :
         {"bench --label 'a" + escape + "'", "bench --scene 'a" + escape + "'", "bench --filter '(" + escape + "'",
          "'draw" + escape + "'", "bench '--" + escape + "'", "bench --benchmark_context='a=" + escape + "'",
          "compare '" + escape + ".json' b.json"}) {
        const Ended ended = run(arguments);
        EXPECT_GT(ended.code, 0) << arguments;
        expect_printable(ended.out + ended.errors);
    }
}

TEST_F(Hostile, no_filter_ends_the_program)
{
    const std::string deep(12'000, '('), shallow(12'000, ')');
    for (const std::string& filter :
         {deep + "nothing" + shallow, deep, std::string("(x+x+)+y"), std::string("(a{999}){999}")}) {
        const Ended ended = run("bench --backend openmp --scene cubes --filter '" + filter + "'");
        EXPECT_EQ(ended.code, 2) << ended.errors.substr(0, 500);
    }
}

TEST_F(Hostile, drivers_of_backends_that_are_not_asked_for_are_not_loaded)
{
    break_drivers();
    const ScopedVariable opencl("OCL_ICD_VENDORS", folder_ / "vendors");
    const ScopedVariable vulkan("VK_ICD_FILENAMES", folder_ / "broken.json");
    const ScopedVariable newer("VK_DRIVER_FILES", folder_ / "broken.json");
    const std::string small = " --isolate none --backend openmp,embree --scene cubes --resolution 4 --size 16 ";
    for (const std::string& arguments :
         {"check" + small, "bench --samples 3 --sample-time 0" + small, "bench --list" + small,
          "bench --samples 3 --sample-time 0 --device cpu" + small,
          "reproduce figure6 --views 0-2 --samples 3 --out r.json" + small}) {
        const Ended ended = run(arguments);
        EXPECT_TRUE(ended.code == 0 || ended.code == 1) << arguments << ended.code << ended.errors;
    }
    const std::string all = run("devices --isolate none").out;
    if (!all.empty()) GTEST_SKIP() << "no driver of OpenCL or Vulkan is loaded here: " << all;
}
