// The scene that can be of any size, as the user meets it.
#include "bench/terminal/text.h"
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Json = nlohmann::json;

class LatticeProgram : public ProgramTest {};

} // namespace

TEST_F(LatticeProgram, is_right_with_every_method_layout_and_schedule)
{
    const Ended ended = run("check --scene lattice:7 --backend openmp,embree,cuda-host --method all --size 24 "
                            "--schedule tiles,persistent,packets --rays primary,ao --threads 1 --out check.json");
    EXPECT_EQ(ended.code, 0) << ended.out << ended.errors;
    const Json result = Json::parse(file("check.json")).at("tetrace");
    EXPECT_EQ(result.at("scenes")[0].at("name"), "lattice:7");
    EXPECT_EQ(result.at("scenes")[0].at("source"), "lattice, 7 along each axis");
    EXPECT_EQ(result.at("scenes")[0].at("tets"), 6 * 7 * 7 * 7);
    std::uint64_t hits = 0;
    for (const Json& row : result.at("rows")) {
        if (row.at("status") == "unsupported") continue; // Embree 4 lacks streams
        hits += row.at("counts").at("hits").get<std::uint64_t>();
    }
    EXPECT_GT(hits, 0u);
}

TEST_F(LatticeProgram, reports_both_numbers_if_a_device_s_buffers_cannot_hold_it)
{
    const Ended ended = run("bench --scene lattice:12 --backend openmp,cuda-host --layout tet80,tet20 --method project "
                            "--size 16 --samples 3 --sample-time 0 --buffer-limit 60000 --format json");
    EXPECT_TRUE(contains(ended.out, "the scene's array 'tets' has 829440 bytes, the largest buffer asked for 60000"))
        << ended.out;
}

TEST_F(LatticeProgram, of_a_size_that_it_cannot_have_is_refused)
{
    const Ended ended = run("render --scene lattice:3 --size 8");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "the number of its cubes along an axis, 4 to 563")) << ended.errors;
}
