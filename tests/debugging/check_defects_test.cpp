#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

using namespace tetrace::test;
using Json = nlohmann::json;

namespace {

class CheckDefects : public ProgramTest {};

} // namespace

TEST_F(CheckDefects, runs_every_kernel_on_every_device_and_exits_with_what_was_seen)
{
    const Ended ended = run("check --defects --out defects.json --junit defects.xml");
    const Json section = Json::parse(file("defects.json"))["tetrace"];
    std::set<std::string> backends;
    bool is_seen = false;
    for (const Json& run : section["defects"]) {
        if (run["outcome"] == "skipped") continue;
        ASSERT_NE(run["outcome"], "error") << run;
        backends.insert(run["backend"].get<std::string>());
        is_seen = is_seen || run["outcome"] == "seen";
        if (run["outcome"] == "seen") {
            EXPECT_NE(run["first_wrong"]["word"], run["first_wrong"]["expected"]);
            EXPECT_TRUE(contains(ended.out, "SEEN: " + std::to_string(run["wrong_items"].size()) + " of 16 items"));
        }
    }
    EXPECT_TRUE(backends.contains("openmp"));
    EXPECT_TRUE(backends.contains("cuda-host"));
    EXPECT_FALSE(backends.contains("embree"));
    EXPECT_EQ(ended.code, is_seen ? 1 : 0) << ended.errors;
    EXPECT_EQ(contains(file("defects.xml"), "<failure "), is_seen);
    EXPECT_TRUE(contains(file("defects.xml"), "tests=\"" + std::to_string(section["defects"].size()) + "\""));
}

TEST_F(CheckDefects, of_a_required_backend_that_is_not_here_fails_with_its_reason_in_the_xml)
{
    const Ended ended = run("check --defects --require cuda --junit defects.xml");
    if (ended.code < 3) GTEST_SKIP() << "there is a CUDA device here";
    EXPECT_EQ(ended.code, 3);
    EXPECT_TRUE(contains(file("defects.xml"), "name=\"has a result\""));
}

TEST_F(CheckDefects, needs_no_scene_and_is_good_where_nothing_is_seen)
{
    const Ended ended = run("check --defects --backend openmp,cuda-host --out defects.json");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "8 reduced kernels ran: 0 show their defect")) << ended.out;
    EXPECT_TRUE(ended.out.ends_with("Conforms  8 reduced kernels on 2 devices.\n")) << ended.out;
    const Ended writing = run("check --defects --backend openmp,cuda-host --write-expect written.json");
    EXPECT_TRUE(contains(writing.out, "Written   written.json\n")) << writing.out;
    EXPECT_TRUE(writing.out.ends_with("Conforms  8 reduced kernels on 2 devices.\n")) << writing.out;
    const Ended lacking = run("check --defects --backend openmp --require cuda-host");
    EXPECT_EQ(lacking.code, 3) << lacking.errors;
    EXPECT_TRUE(lacking.out.ends_with("FAILED    4 of 8 reduced kernels, all on cuda-host.\n")) << lacking.out;
    EXPECT_EQ(run("check --defects --backend embree").code, 3);
    write_file(folder_ / "openmp.json", R"({"defects": {"loop": "right"}})");
    const Ended expecting = run("check --defects --backend openmp --expect openmp.json");
    EXPECT_EQ(expecting.code, 0) << expecting.errors;
    EXPECT_TRUE(contains(expecting.out, "openmp.json: defects.loop: no reduced kernel or stressor has this name"))
        << expecting.out;
}

TEST_F(CheckDefects, stress_runs_stressors_alone_up_to_a_million_items)
{
    const Ended ended = run("check --stress --backend openmp --out stress.json --junit stress.xml");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    const Json runs = Json::parse(file("stress.json"))["tetrace"]["defects"];
    ASSERT_GE(runs.size(), 11u);
    for (const Json& run : runs) {
        EXPECT_EQ(run["outcome"], "not seen") << run;
        EXPECT_EQ(run["items"], 1'000'000) << run;
    }
    EXPECT_TRUE(contains(ended.out, std::to_string(runs.size()) + " kernels ran: 0 have wrong results")) << ended.out;
    EXPECT_TRUE(contains(file("stress.xml"), "name=\"defect/zoo_of_exits\""));
    EXPECT_EQ(run("show stress.json").code, 0);
    EXPECT_EQ(run("check --stress --resume --out stress.json").code, 2);
}

TEST_F(CheckDefects, are_not_shared_among_processes)
{
    const Ended ended = run("check --defects --shard 1/2 --out defects.json");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "--defects takes only seconds and cannot be sharded")) << ended.errors;
}
