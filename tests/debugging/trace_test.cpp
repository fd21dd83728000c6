#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tetrace::test;
using Json = nlohmann::json;

namespace {

class Trace : public ProgramTest {
protected:
    const std::string cubes_ = "trace --scene cubes --resolution 6 --size 24 --camera-set smoke ";

    Json traced(const std::string& arguments, int code = 0)
    {
        const Ended ended = run(cubes_ + arguments + " --out ray.json");
        EXPECT_EQ(ended.code, code) << ended.errors << ended.out;
        return Json::parse(file("ray.json"))["tetrace"]["trace"];
    }

    void expect_refused(const std::string& arguments, const std::string& reason)
    {
        const Ended ended = run("trace " + arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_TRUE(contains(ended.errors, reason)) << ended.errors;
    }
};

} // namespace

TEST_F(Trace, shows_the_same_steps_on_every_device_here)
{
    for (const std::string kernel : {"--method maria", "--method project"}) {
        const Json trace = traced("--pixel 12,11 " + kernel);
        EXPECT_EQ(trace["devices"][0]["backend"], "openmp");
        EXPECT_EQ(trace["pixel"], (std::vector<int>{12, 11}));
        for (const Json& device : trace["devices"]) {
            ASSERT_EQ(device["status"], "ok") << device["backend"];
            EXPECT_FALSE(device["differs"].get<bool>()) << device["backend"];
            EXPECT_EQ(device["hit"]["steps"], device["steps"].size());
            EXPECT_EQ(device["hit"], device["alone"]);
            for (std::size_t i = 0; i < device["steps"].size(); ++i)
                for (const char* const key : {"tet", "face", "beyond"})
                    EXPECT_EQ(device["steps"][i][key], trace["devices"][0]["steps"][i][key]) << device["backend"];
        }
    }
}

TEST_F(Trace, has_openmp_first_whatever_is_asked_for)
{
    const Json trace = traced("--pixel 12,11 --backend cuda-host --view 2");
    ASSERT_EQ(trace["devices"].size(), 2u);
    EXPECT_EQ(trace["devices"][0]["backend"], "openmp");
    EXPECT_EQ(trace["devices"][1]["backend"], "cuda-host");
    EXPECT_EQ(trace["view"], 2);
    const Ended shown = run(cubes_ + "--pixel 12,11 --backend cuda-host");
    EXPECT_TRUE(contains(shown.out, "cuda-host: the steps are openmp's, and its hit is the same, bit for bit."))
        << shown.out;
}

TEST_F(Trace, follows_given_rays_from_the_face_on_which_they_start)
{
    for (const std::string rays : {"shadow", "ao", "diffuse", "random"})
        for (const std::string kernel : {"--method maria", "--method project"}) {
            SCOPED_TRACE(rays + " " + kernel);
            const Json trace = traced("--pixel 12,11 --backend openmp,cuda-host --rays " + rays + " " + kernel);
            EXPECT_EQ(trace["rays"], rays);
            EXPECT_EQ(trace.contains("start"), rays != "random") << "lines come from outside";
            EXPECT_EQ(trace.contains("end"), rays == "shadow" || rays == "ao");
            for (const Json& device : trace["devices"]) {
                EXPECT_FALSE(device["differs"].get<bool>());
                EXPECT_EQ(device["hit"], device["alone"]);
                EXPECT_EQ(device["hit"]["steps"], device["steps"].size());
                if (trace.contains("start")) {
                    EXPECT_EQ(device["steps"][0]["tet"], trace["start"]["tet"]);
                }
            }
        }
    EXPECT_EQ(traced("--pixel 12,11 --backend openmp --rays diffuse --ray-order shuffled")["devices"],
              traced("--pixel 12,11 --backend openmp --rays diffuse")["devices"])
        << "the same ray, wherever it is in the order";
}

TEST_F(Trace, shows_of_a_bvh_the_answers_and_what_openmp_visits)
{
    for (const std::string rays : {"", "--rays diffuse"}) {
        const Json trace = traced("--pixel 12,11 --layout bvh2 --backend openmp,cuda-host " + rays);
        EXPECT_GT(trace["devices"][0]["visits"]["nodes"], 0);
        EXPECT_FALSE(trace["devices"][1].contains("visits"));
        for (const Json& device : trace["devices"]) {
            EXPECT_TRUE(device["steps"].empty());
            EXPECT_FALSE(device["differs"].get<bool>());
            EXPECT_EQ(device["hit"], device["alone"]);
        }
    }
    const std::string text = run(cubes_ + "--pixel 12,11 --layout bvh2 --backend openmp,cuda-host").out;
    EXPECT_TRUE(contains(text, "cuda-host: its hit is the same, bit for bit.")) << text;
    EXPECT_TRUE(contains(text, "so no steps are shown")) << text;
}

TEST_F(Trace, of_a_ray_that_there_is_not_is_refused)
{
    const std::string scene = "--scene cubes --resolution 6 --size 24 --camera-set smoke --backend openmp ";
    expect_refused(scene + "--pixel 24,0", "--pixel: 24,0 is outside the image, whose pixels go from 0,0 to 23,23");
    expect_refused(scene + "--pixel 0,24", "is outside the image");
    expect_refused(scene + "--pixel 3", "X,Y");
    expect_refused(scene + "--pixel 3,4,5", "X,Y");
    expect_refused(scene + "--pixel=-1,4", "--pixel");
    expect_refused(scene, "--pixel X,Y is missing");
    expect_refused(scene + "--pixel 1,1 --view 4", "4");
    expect_refused(scene + "--pixel 1,1 --layout embree", "is not one of tetrace's kernels");
    expect_refused(scene + "--pixel 1,1 --method maria,project", "accepts one value");
    expect_refused(scene + "--pixel 1,1 --method maria --layout half32",
                   "no kernel of task trace has method maria and layout half32");
    expect_refused(scene + "--pixel 0,0 --rays shadow", "--pixel: 0,0 makes no shadow ray");
    expect_refused(scene + "--pixel 1,1 --rays shadow,ao", "--rays accepts one value");
    expect_refused("--pixel 1,1", "--scene SCENE is missing: which scene?");
    expect_refused("--scene cubes,banana --pixel 1,1", "--scene accepts one scene");
}

TEST_F(Trace, without_the_device_that_was_asked_for_is_no_success)
{
    const Ended ended = run(cubes_ + "--pixel 12,11 --backend cuda");
    if (ended.code == 0) GTEST_SKIP() << "there is a CUDA device here";
    EXPECT_EQ(ended.code, 3) << ended.out;
    EXPECT_TRUE(contains(ended.errors, "nothing was traced")) << ended.errors;
}
