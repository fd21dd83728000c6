// `bench` with several sizes of images and several numbers of threads, and what is done with its result.
#include "tests/support/program_fixture.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

using namespace tetrace;
using namespace tetrace::test;
using nlohmann::json;

namespace {

class Axes : public ProgramTest {
protected:
    static constexpr const char* bench =
        "bench --backend openmp --scene cubes --resolution 3 --size 16,32 --threads 1,2 "
        "--method maria,single --layout tet80,bvh2 --schedule tiles --views 0,1 "
        "--samples 5 --sample-time 0 ";

    [[nodiscard]] json section(const char* name) const { return json::parse(file(name)).at("tetrace"); }
    [[nodiscard]] std::set<std::string> names(const char* name) const
    {
        const json result = section(name);
        std::set<std::string> all;
        for (const json& row : result.at("rows"))
            all.insert(row.at("name"));
        return all;
    }
};

} // namespace

TEST_F(Axes, have_a_row_at_each_size_with_each_number_of_threads)
{
    const Ended ended = run(std::string(bench) + "--out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(names("r.json").size(), 8u);
    EXPECT_TRUE(names("r.json").contains("cdt/maria/tet80/cubes/size:32/primary/math:exact/api:openmp/threads:1"));
    const json result = section("r.json");
    EXPECT_EQ(result.at("threads"), 2);
    EXPECT_EQ(result.at("scenes").size(), 2u);
    for (const json& row : result.at("rows")) {
        const bool is_small = row.at("scene") == "cubes/size:16";
        EXPECT_EQ(row.at("counts").at("rays"), 2 * (is_small ? 16 * 16 : 32 * 32));
        EXPECT_EQ(row.contains("threads"), row.at("name").get<std::string>().ends_with("/threads:1"));
        if (row.at("rates").contains("best_bvh")) {
            EXPECT_EQ(row.at("rates").at("best_bvh").get<std::string>().ends_with("/threads:1"),
                      row.contains("threads"))
                << "rows with as many threads are compared";
        }
    }
    for (const Ended& shown : {ended, run("show r.json")}) {
        EXPECT_TRUE(contains(shown.out, "rates by size")) << shown.out;
        EXPECT_TRUE(contains(shown.out, "rates by threads"));
        EXPECT_TRUE(contains(shown.out, "at 16x16, 32x32 on 1, 2 threads"));
    }
    ASSERT_EQ(run("report r.json --out page.html --charts charts").code, 0);
    for (const char* const chart :
         {"sizes-rate-by-image-size-cubes-processors.svg", "threads-speed-up-by-threads-cubes-size-32-processors.svg"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / "charts" / chart)) << chart;
    const Ended compared = run("compare r.json r.json");
    EXPECT_EQ(compared.code, 0) << compared.errors;
    EXPECT_TRUE(contains(compared.out, "8 of 8 rows")) << compared.out;
}

TEST_F(Axes, of_shards_are_merged)
{
    ASSERT_EQ(run(std::string(bench) + "--shard 1/2 --out a.json").code, 0);
    ASSERT_EQ(run(std::string(bench) + "--shard 2/2 --out b.json").code, 0);
    const Ended merged = run("merge a.json b.json --out m.json");
    ASSERT_EQ(merged.code, 0) << merged.errors;
    EXPECT_EQ(names("m.json"), names("a.json"));
    EXPECT_TRUE(contains(merged.out, "rates by size")) << merged.out;
    EXPECT_TRUE(contains(merged.out, "rates by threads"));
    const json result = section("m.json");
    for (const json& row : result.at("rows"))
        EXPECT_EQ(row.at("counts").at("rays").get<int>() % 512, 0) << "both views";
}
