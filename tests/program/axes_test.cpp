// `bench` with several sizes of images and several numbers of threads, and what is done with its result.
#include "tests/support/program_fixture.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

using namespace tetrace;
using namespace tetrace::test;
using Json = nlohmann::json;

namespace {

class Axes : public ProgramTest {
protected:
    static constexpr const char* bench =
        "bench --backend openmp --scene cubes --resolution 3 --size 16,32 --threads 1,2 "
        "--method maria,single --layout tet80,bvh2 --schedule tiles --views 0,1 "
        "--samples 5 --sample-time 0 ";

    [[nodiscard]] Json section(const char* name) const { return Json::parse(file(name)).at("tetrace"); }
    [[nodiscard]] std::set<std::string> names(const char* name) const
    {
        const Json result = section(name);
        std::set<std::string> all;
        for (const Json& row : result.at("rows"))
            all.insert(row.at("name"));
        return all;
    }
    /// What a result says of its rows, but for times.
    [[nodiscard]] Json answers(const char* name) const
    {
        Json all = Json::object();
        const Json result = section(name);
        for (const Json& row : result.at("rows"))
            all[row.at("name").get<std::string>()] = {row.at("status"), row.at("counts"), row.at("verification"),
                                                      row.at("views_hash"), row.at("times").at("samples_s").size()};
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
    const Json result = section("r.json");
    EXPECT_EQ(result.at("threads"), 2);
    EXPECT_EQ(result.at("scenes").size(), 2u);
    for (const Json& row : result.at("rows")) {
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

TEST_F(Axes, of_two_tasks_are_apart_resumed_and_compared_with_one_size)
{
    const std::string arguments = "bench --backend openmp --scene cubes --resolution 3 --size 16,32 --threads 1,2 "
                                  "--method project --layout tet80 --schedule tiles --task trace,segments --views 0,1 "
                                  "--samples 5 --sample-time 0 ";
    ASSERT_EQ(run(arguments + "--out whole.json").code, 0);
    EXPECT_EQ(names("whole.json").size(), 8u);
    const Ended shown = run("show whole.json");
    EXPECT_TRUE(contains(shown.out, "segments project tet80")) << shown.out;
    EXPECT_TRUE(contains(shown.out, "cdt project tet80"));
    ASSERT_EQ(run("report whole.json --out page.html").code, 0);
    EXPECT_TRUE(contains(file("page.html"), "segments project tet80  openmp")) << "a line of its own";
    EXPECT_EQ(run("compare whole.json whole.json").code, 0);
    ASSERT_EQ(run(arguments + "--out m1.json --shard 1/2").code, 0);
    ASSERT_EQ(run(arguments + "--out m2.json --shard 2/2").code, 0);
    ASSERT_EQ(run("merge m1.json m2.json --out m.json").code, 0);
    EXPECT_EQ(answers("m.json"), answers("whole.json"));

    {
        const ScopedVariable disk("LD_PRELOAD", TETRACE_FAULTY_DISK), how("FAULTY_DISK", "sync:6 io");
        EXPECT_EQ(run(arguments + "--out r.json").code, 2);
    }
    ASSERT_TRUE(std::filesystem::exists(folder_ / "r.json.journal"));
    ASSERT_EQ(run(arguments + "--out r.json --resume").code, 0);
    EXPECT_EQ(answers("r.json"), answers("whole.json")) << "of each size, number of threads and task";

    std::string alone = arguments;
    alone.replace(alone.find("16,32"), 5, "32");
    ASSERT_EQ(run(alone + "--out alone.json").code, 0);
    const Ended compared = run("compare whole.json alone.json --allow-missing");
    EXPECT_TRUE(contains(compared.out, "4 of 8 rows")) << compared.out << compared.errors;
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
    const Json result = section("m.json");
    for (const Json& row : result.at("rows"))
        EXPECT_EQ(row.at("counts").at("rays").get<int>() % 512, 0) << "both views";
}
