// How portable the performance of APIs and layouts is, from results of several platforms.
#include "bench/report/campaign/portability.h"
#include "tests/output/report_fixture.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

struct Measured {
    const char *backend, *type, *layout;
    double mrays_per_s;
    const char* status = "ok";
    bool noisy = false;
};

json result_of_rows(const std::string& label, const std::vector<Measured>& rows)
{
    json result = bench_json();
    json& section = result["tetrace"];
    section["label"] = label;
    section["threads"] = 2;
    section["ratios"] = section["rows"] = json::array();
    for (const Measured& one : rows) {
        json row = row_json(fmt::format("row/{}/{}/{}", one.backend, one.layout, one.mrays_per_s), one.backend,
                            one.type, innocent);
        row.update({{"layout", one.layout}, {"status", one.status}});
        row["device"]["name"] = std::string("a ") + one.type;
        row["rates"]["mrays_per_s"] = one.mrays_per_s;
        row["times"]["noisy"] = one.noisy;
        section["rows"].push_back(row);
    }
    return result;
}

class Portability : public testing::Test {
protected:
    Campaign campaign_of(const std::vector<json>& results)
    {
        std::vector<std::filesystem::path> files;
        for (const json& result : results) {
            files.push_back(folder_ / fmt::format("{}.json", files.size()));
            write_file(files.back(), result.dump());
        }
        return read_campaign(files);
    }
    TemporaryFolder folder_;
};

/// Two GPUs and an emulated one: vulkan runs on both GPUs, cuda on one.
std::vector<json> three_platforms()
{
    return {result_of_rows("one", {{"cuda", "gpu", "tet80", 100},
                                   {"vulkan", "gpu", "tet80", 80},
                                   {"vulkan", "gpu", "tet80", 60},
                                   {"vulkan", "emulated", "tet80", 1},
                                   {"opencl", "gpu", "tet80", 500, "flawed"}}),
            result_of_rows("two", {{"vulkan", "gpu", "tet80", 30}, {"vulkan", "gpu", "tet96", 40, "ok", true}})};
}

} // namespace

TEST_F(Portability, of_an_application_is_its_best_rate_over_the_platforms_best)
{
    const std::string csv = portability_table(efficiencies_of(campaign_of(three_platforms()))).csv();
    const std::string problem = "\"cubes: 2 views of smoke at 24 × 16, primary rays, scene 0123456789abcdef\"";
    EXPECT_EQ(csv,
              "problem,platform,application,efficiency,noisy,mrays_per_s\n" +
                  fmt::format("{0},a gpu in one,cuda tet80,1,,100\n{0},a gpu in one,vulkan tet80,0.8,,80\n"
                              "{0},a gpu in two,vulkan tet80,0.75,yes,30\n{0},a gpu in two,vulkan tet96,1,yes,40\n",
                              problem))
        << "without the emulated device and the flawed row; noisy over a noisy best";
}

TEST(PortabilityMetric, is_the_harmonic_mean_and_0_if_a_platform_is_missing)
{
    EXPECT_DOUBLE_EQ(performance_portability({0.5, 1}, 2), 2 / 3.0);
    EXPECT_DOUBLE_EQ(performance_portability({1, 1, 1}, 3), 1);
    EXPECT_EQ(performance_portability({1, 1}, 3), 0);
}

TEST_F(Portability, is_a_cascade_of_each_application_on_the_page_of_a_folder)
{
    const std::string section = section_of(campaign_page(campaign_of(three_platforms()), {}), "portability");
    EXPECT_TRUE(contains(section, "data-row=\"vulkan tet80  P 0.77, noisy\"")) << section;
    EXPECT_TRUE(contains(section, "data-row=\"cuda tet80  P 0, on 1 of 2\""));
    EXPECT_TRUE(contains(section, "0.75<small>noisy</small>"));
    EXPECT_LT(section.find("vulkan tet80  P"), section.find("cuda tet80  P")) << "the most portable first";
    EXPECT_TRUE(
        contains(section_of(campaign_page(campaign_of({three_platforms()[0]}), {}), "portability"), "no section"))
        << "of one platform";
}
