#include "tests/support/program_fixture.h"

#include <filesystem>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr const char* tiny = " --backend openmp --layout tet80 --scene cubes --resolution 3 --size 64 ";

/// The program as on a full disk: no file may be longer than a kilobyte or two.
class Files : public ProgramTest {
protected:
    Ended run_on_full_disk(const std::string& arguments) { return run_script("ulimit -f 2", arguments, "/dev/null"); }

    /// Runs the program after a command of the shell, its standard output in a file.
    Ended run_script(const std::string& first, const std::string& arguments, const std::string& out)
    {
        write_file(folder_ / "script", first + "\nexec '" TETRACE_PROGRAM "' \"$@\"\n");
        const std::string errors = (folder_ / "stderr").string();
        const int status =
            std::system(fmt::format("cd '{0}' && XDG_CACHE_HOME='{0}/cache' sh ./script {1} > {2} 2> {3}",
                                    folder_.path().string(), arguments, out, errors)
                            .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {}, read_text(errors)};
    }

    /// A file that a verb was to write: the program fails with the reason, and what was there before is still there.
    void expect_refusal(const std::string& arguments, const std::string& name)
    {
        write_file(folder_ / name, "before");
        const Ended ended = run_on_full_disk(arguments);
        EXPECT_EQ(ended.code, 2) << arguments << "\n" << ended.errors;
        EXPECT_TRUE(contains(ended.errors, name)) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "File too large")) << ended.errors;
        EXPECT_EQ(file(name.c_str()), "before") << arguments;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    }
};

} // namespace

TEST_F(Files, pictures_are_whole_or_not_written)
{
    const std::string render = std::string("render --views 0") + tiny;
    expect_refusal(render + "--out a.ppm", "a.ppm");
    if (run(render + "--out good.png").code == 3) GTEST_SKIP() << "without OpenImageIO there are only PPM files";
    expect_refusal(render + "--out a.exr", "a.exr");
    expect_refusal(render + "--picture steps --out a.png", "a.png");
    expect_refusal(render + "--picture hits --out b.exr", "b.exr");
}

TEST_F(Files, hits_need_openimageio_and_say_so)
{
    std::filesystem::copy_file(TETRACE_PROGRAM, folder_ / "alone"); // the module is searched next to the program
    for (const char* const out : {"", "--out a.exr", "--out ."}) {
        const Ended ended = run(std::string("render --views 0 --picture normals,hits ") + tiny + out, "./alone");
        EXPECT_EQ(ended.code, 3) << out << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "libopenimageio-dev")) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "other than hits")) << ended.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "cubes-0-normals.ppm"));
}

TEST_F(Files, several_pictures_end_with_the_first_that_cannot_be_written)
{
    const Ended ended = run_on_full_disk(std::string("render --views 0,1 --out a.ppm") + tiny);
    EXPECT_EQ(ended.code, 2) << ended.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a-cubes-0-normals.ppm"));
}

TEST_F(Files, results_are_whole_or_not_written)
{
    expect_refusal(std::string("check --out a.json") + tiny, "a.json");
    expect_refusal(std::string("check --junit a.xml --method all") + tiny, "a.xml");
    expect_refusal(std::string("bench --samples 3 --sample-time 0 --out a.json") + tiny, "a.json");
    expect_refusal(std::string("bench --samples 3 --sample-time 0 --benchmark_out=gb.json") + tiny, "gb.json");
    ASSERT_EQ(run(std::string("bench --samples 3 --sample-time 0 --out good.json") + tiny).code, 0);
    expect_refusal("report good.json --out a.html", "a.html");
    expect_refusal("compare good.json good.json --out a.json", "a.json");
    expect_refusal("devices --out a.json", "a.json");
}

TEST_F(Files, a_dash_means_standard_output)
{
    const std::string bench = std::string("bench --samples 3 --sample-time 0 --format json --out -") + tiny;
    EXPECT_EQ(run(bench).out.rfind("{", 0), 0u);
    const Ended check = run(std::string("check --junit - --out check.json") + tiny);
    EXPECT_EQ(check.code, 0) << check.errors;
    EXPECT_EQ(check.out.rfind("<?xml", 0), 0u) << check.out;
    EXPECT_TRUE(check.out.ends_with("</testsuites>\n")) << check.out;
    EXPECT_TRUE(contains(file("check.json"), "\"rows\""));
    const Ended report = run("report check.json --out -");
    EXPECT_EQ(report.out.rfind("<!DOCTYPE html>", 0), 0u) << report.out.substr(0, 100);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "-"));
}

TEST_F(Files, one_exit_code_reports_every_missing_file)
{
    for (const char* const arguments :
         {"report none.json", "compare none.json none.json", "bench --backend openmp --scene none.ply",
          "check --backend openmp --scene none.tet", "build --scene none.ply", "render --scene none.off"}) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 3) << arguments << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "none.")) << ended.errors;
    }
}

TEST_F(Files, what_cannot_be_printed_is_an_error)
{
    for (const char* const arguments : {"check", "bench --samples 3 --sample-time 0 --benchmark_format=json"}) {
        const Ended ended = run_script(":", std::string(arguments) + tiny, "/dev/full");
        EXPECT_EQ(ended.code, 2) << arguments << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "standard output")) << ended.errors;
    }
}
