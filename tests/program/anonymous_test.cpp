#include "bench/options/identity.h"

#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::string anonymous(const std::string& text)
{
    return anonymous_text(text, {});
}

class AnonymousProgram : public ProgramTest {
protected:
    /// The program as on a host of that name; false if this system does not let one be named.
    static bool can_name_a_host() { return std::system("unshare -u true 2> /dev/null") == 0; }
    Ended run_on_host(const std::string& name, const std::string& arguments)
    {
        write_file(folder_ / "on-host", "#!/bin/sh\nhostname " + name + "\nexec '" TETRACE_PROGRAM "' \"$@\"\n");
        const std::string out = (folder_ / "stdout").string(), errors = (folder_ / "stderr").string();
        const std::string command =
            fmt::format("cd '{0}' && XDG_CACHE_HOME='{0}/cache' unshare -u sh ./on-host {1} > '{2}' 2> '{3}'",
                        folder_.path().string(), arguments, out, errors);
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(errors)};
    }
};

constexpr const char* tiny_rows = " --scene cubes --resolution 3 --size 8 --backend openmp,embree ";

} // namespace

TEST(Anonymous, keeps_of_a_path_its_last_part)
{
    EXPECT_EQ(anonymous("reading '/home/ann/my meshes/dragon.ply': it is empty"), "reading 'dragon.ply': it is empty");
    EXPECT_EQ(anonymous("/srv/ann/a.tet"), "a.tet");
    EXPECT_EQ(anonymous("-ffile-prefix-map=/srv/ann/source=."), "-ffile-prefix-map=source=.");
    EXPECT_EQ(anonymous("cannot open /usr/lib/libcuda.so.1: no such file"), "cannot open libcuda.so.1: no such file");
    EXPECT_EQ(anonymous("two: /a/b/c/, /d/e/f.x"), "two: c, f.x");
    EXPECT_EQ(anonymous("<failure message=&apos;/a/b/c.ply&apos;>"), "<failure message=&apos;c.ply&apos;>");
}

TEST(Anonymous, leaves_no_folder_of_a_person)
{
    EXPECT_EQ(anonymous("the folder /home/ann is full"), "the folder (a folder) is full");
    EXPECT_EQ(anonymous("'/home/ann'"), "'(a folder)'");
    const ScopedVariable home("HOME", "/data/people/ann");
    EXPECT_EQ(anonymous("the folder /data/people/ann is full"), "the folder ~ is full");
    EXPECT_EQ(anonymous("'/data/people/ann/secret/x.ply'"), "'x.ply'");
    EXPECT_EQ(anonymous("/data/people/anne/x.ply"), "x.ply");
}

TEST(Anonymous, leaves_all_else_unchanged)
{
    for (const char* const text :
         {"cdt/maria/tet80/bunny/primary/math:exact/api:openmp", "Mrays/s", "1 / 2", "a /", "/", "", "and/or",
          "https://example.org/a/b", "Release -O3 -DNDEBUG; kernels exact: -ffp-contract=off", "'it''s'"})
        EXPECT_EQ(anonymous(text), text);
}

TEST(Anonymous, shortens_the_paths_that_the_options_name)
{
    Options options;
    options.scenes = {"secret project/dragon.ply", "bunny"};
    options.code_folder = "secret project/code";
    options.expected = {"secret project/known/"};
    options.own_cameras = OwnCameras{"mine", {}, "secret project/cameras.json"};
    options.benchmark_flags = {"--benchmark_out=secret project/gb.json", "--benchmark_filter=cdt/maria"};
    EXPECT_EQ(
        anonymous_text("tetrace bench --scene 'secret project/dragon.ply' --camera-set 'secret project/cameras.json' "
                       "--code 'secret project/code' '--benchmark_out=secret project/gb.json' cdt/maria",
                       options),
        "tetrace bench --scene 'dragon.ply' --camera-set 'cameras.json' --code 'code' '--benchmark_out=gb.json' "
        "cdt/maria");
    EXPECT_EQ(anonymous_text("check --expect 'secret project/known/'", options), "check --expect 'known/'");
    EXPECT_EQ(anonymous_text("scene secret project/dragon.ply: broken; bunny/primary", options),
              "scene dragon.ply: broken; bunny/primary");
}

TEST(Anonymous, goes_through_all_of_a_result)
{
    const nlohmann::json result = {{"tetrace", {{"rows", {{{"reason", "'/home/ann/x.ply'"}, {"bytes", 7}}}}}}};
    const nlohmann::json expected = {{"tetrace", {{"rows", {{{"reason", "'x.ply'"}, {"bytes", 7}}}}}}};
    EXPECT_EQ(anonymous_json(result, {}), expected);
}

TEST(Anonymous, elements_of_junit_are_closed_still)
{
    EXPECT_EQ(anonymous_text("<case>/home/ann/x.ply</case>\n</suite>\n", {}), "<case>x.ply</case>\n</suite>\n");
    EXPECT_EQ(anonymous_text("#include </home/ann/x.h>", {}), "#include <x.h>");
}

TEST_F(AnonymousProgram, results_hold_neither_the_hosts_name_nor_a_folder)
{
    if (!can_name_a_host()) GTEST_SKIP() << "this system lets nobody name a host: 'unshare -u' is not permitted";
    const std::string folder = folder_.path().string();
    write_file(folder_ / "private/broken.tet", "no scene");
    const std::string scenes = fmt::format("--scene {}/private/broken.tet", folder);
    for (const std::string& arguments :
         {std::string("bench --samples 3 --sample-time 0"), std::string("check --junit {0}/check.xml")}) {
        const std::string verb = fmt::format(fmt::runtime(arguments), folder) + tiny_rows + scenes;
        const Ended named = run_on_host("secrethost", verb + " --out named.json");
        EXPECT_TRUE(contains(file("named.json"), "private/broken.tet")) << "else there is nothing to leave out";
        EXPECT_NE(named.out.find("private/broken.tet"), std::string::npos);
        const Ended ended = run_on_host("secrethost", verb + " --anonymous --out result.json");
        for (const std::string& text : {file("result.json"), ended.out, file("check.xml")}) {
            EXPECT_EQ(text.find("secrethost"), std::string::npos) << text;
            EXPECT_EQ(text.find("private"), std::string::npos) << text;
            EXPECT_EQ(text.find(folder), std::string::npos) << text;
        }
        EXPECT_TRUE(contains(file("result.json"), "broken.tet"));
    }
}

TEST_F(AnonymousProgram, google_benchmark_names_the_host_unless_anonymous)
{
    if (!can_name_a_host()) GTEST_SKIP() << "this system lets nobody name a host: 'unshare -u' is not permitted";
    ASSERT_EQ(run_on_host("secrethost",
                          std::string("bench --samples 3 --sample-time 0 --benchmark_out=named.json ") + tiny_rows)
                  .code,
              0);
    EXPECT_TRUE(contains(file("named.json"), "secrethost")) << "so the other test can fail";
}

TEST_F(AnonymousProgram, does_not_go_with_google_benchmarks_own_json)
{
    for (const char* const flag : {"--benchmark_format=json", "--benchmark_out=gb.json"}) {
        const Ended ended = run(std::string("bench --samples 3 --sample-time 0 --anonymous ") + tiny_rows + flag);
        EXPECT_EQ(ended.code, 2) << flag;
        EXPECT_TRUE(contains(ended.errors, "names the host")) << ended.errors;
    }
    EXPECT_EQ(
        run(std::string("bench --samples 3 --sample-time 0 --anonymous --benchmark_format=csv ") + tiny_rows).code, 0);
}
