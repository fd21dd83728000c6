#include "tests/reproduce/reproduce_fixture.h"

using namespace tetrace::test;

namespace {

class VolumeRun : public ReproduceTest {};

} // namespace

TEST_F(VolumeRun, compares_bits_and_sums_counts_lost_rays_and_tests_uniform_lines)
{
    const Ended ended = run("volume --scene cubes --resolution 6 --size 64 --samples 3 --sample-time 0 --backend "
                            "openmp,cuda-host --out page.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto page = result("page.json");
    const auto& volume = of_id(page.at("tables"), "volume");
    ASSERT_EQ(volume.at("rows").size(), 10u + 4 + 4) << "segments; tally and absorb";
    EXPECT_EQ(page.at("rows").size(), 2 * volume.at("rows").size() - 5)
        << "only openmp has packets and two methods in double";
    const auto number = [](const nlohmann::json& row, const char* key) {
        return row.at(key).at("value").get<double>();
    };
    for (const auto& row : volume.at("rows")) {
        const std::string name = row.at("row");
        const bool is_openmps =
            contains(name, "packets") || contains(name, "plucker64") || contains(name, "barycentric");
        EXPECT_EQ(row.at("same"), is_openmps ? "1 of 1" : "2 of 2") << row;
        EXPECT_EQ(number(row, "rays"), 2 * 64 * 64) << row;
        EXPECT_GT(number(row, "mrays_per_s_openmp"), 0) << row;
        EXPECT_EQ(row.contains("sums"), name.starts_with("tally")) << row;
        EXPECT_EQ(row.value("sums", "equal"), "equal") << row;
        EXPECT_EQ(number(row, "wrong") + number(row, "lost"), 0) << row;
    }
    for (const auto& claim : volume.at("claims"))
        EXPECT_EQ(claim.at("verdict"), "holds") << claim;
    const auto& lines = of_id(page.at("tables"), "volume-lines");
    ASSERT_EQ(lines.at("rows").size(), 1u);
    EXPECT_EQ(number(lines.at("rows")[0], "lines"), 2 * 64 * 64);
    EXPECT_EQ(lines.at("rows")[0].at("verdict"), "passed") << lines;
    EXPECT_TRUE(contains(ended.out, "testable")) << ended.out;
}

TEST_F(VolumeRun, goes_on_after_the_scenes_of_its_journal)
{
    const std::string volume = "volume --scene cubes,lattice:4 --resolution 4 --size 48 --samples 3 --method project "
                               "--layout tet64 --out r.json";
    ASSERT_EQ(end(start(volume, 2, SIGINT)).code, 130);
    const auto before = result("r.json");
    ASSERT_EQ(run(volume + " --resume").code, 0);
    const auto after = result("r.json");
    EXPECT_GT(before.at("rows").size(), 2u);
    EXPECT_EQ(after.at("rows").size(), 2 * before.at("rows").size());
    for (std::size_t i = 0; i < before.at("rows").size(); ++i)
        EXPECT_EQ(after.at("rows")[i].at("times"), before.at("rows")[i].at("times"));
    const auto &lines = of_id(after.at("tables"), "volume-lines").at("rows"),
               &earlier = of_id(before.at("tables"), "volume-lines").at("rows");
    ASSERT_EQ(earlier.size(), 1u);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0], earlier[0]);
}

TEST_F(VolumeRun, wrong_command_lines_are_refused)
{
    for (const std::string bad : {"volume,ladder", "volume --camera-set orbit", "volume --shard 1/2 --out a.json"})
        EXPECT_EQ(run(bad).code, 2) << bad;
}
