// `bench --launches-in-flight`, and what is done with its result.
#include "tests/support/program_fixture.h"

#include <nlohmann/json.hpp>

using namespace tetrace;
using namespace tetrace::test;
using Json = nlohmann::json;

namespace {

class InFlight : public ProgramTest {
protected:
    static constexpr const char* rows =
        "--scene cubes --resolution 3 --size 16 --method maria,single --layout tet80,bvh2 "
        "--schedule tiles --views 0,1 --samples 5 --sample-time 0.01 ";
};

} // namespace

TEST_F(InFlight, launches_are_reported_in_table_json_and_page_and_compared_only_with_as_many)
{
    const std::string arguments = std::string("bench --backend openmp,cuda-host ") + rows;
    const Ended ended = run(arguments + "--launches-in-flight 2 --out two.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    ASSERT_EQ(run(arguments + "--out one.json").code, 0);
    const Json two = Json::parse(file("two.json")).at("tetrace"), one = Json::parse(file("one.json")).at("tetrace");
    ASSERT_EQ(two.at("rows").size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        const Json& row = two.at("rows")[i];
        const std::string name = row.at("name");
        const bool is_host = row.at("backend") == "openmp";
        EXPECT_EQ(row.at("status"), "ok") << name;
        EXPECT_EQ(row.value("launches_in_flight", 1), is_host ? 1 : 2) << name;
        EXPECT_EQ(name.ends_with("/in_flight:2"), !is_host) << name;
        EXPECT_EQ(row.at("hit_hash"), one.at("rows")[i].at("hit_hash")) << name;
        EXPECT_GE(row.at("times").value("passes", 1), is_host ? 1 : 2) << "one for each output";
        if (is_host) continue;
        EXPECT_TRUE(row.at("times").contains("latency_s"));
        EXPECT_FALSE(row.at("times").contains("fixed_s"));
        EXPECT_FALSE(row.at("times").contains("s_per_mray"));
    }
    EXPECT_EQ(one.at("ratios").size(), 2u);
    EXPECT_TRUE(two.at("ratios").empty()) << "openmp has one launch in flight: " << two.at("ratios");
    for (const Ended& shown : {ended, run("show two.json")})
        EXPECT_TRUE(contains(shown.out, "cuda-host, 2 in flight")) << shown.out;
    ASSERT_EQ(run("report two.json --out page.html").code, 0);
    EXPECT_TRUE(contains(file("page.html"), "cuda-host, 2 in flight"));
    const Ended compared = run("compare one.json two.json --allow-missing");
    EXPECT_TRUE(contains(compared.out, "2 of 6 rows")) << compared.out << compared.errors;
    EXPECT_EQ(run("show two.json --out again.json").code, 0);
    EXPECT_EQ(Json::parse(file("again.json")), Json::parse(file("two.json")));
}

TEST_F(InFlight, launches_are_refused_where_no_row_can_have_them)
{
    const Ended host = run(std::string("bench --backend openmp,embree --launches-in-flight 2 ") + rows);
    EXPECT_EQ(host.code, 2);
    EXPECT_TRUE(contains(host.errors, "--launches-in-flight 2: no selected row can have several")) << host.errors;
    for (const char* const count : {"0", "9", "two"})
        EXPECT_EQ(run(fmt::format("bench --launches-in-flight {} {}", count, rows)).code, 2) << count;
    EXPECT_EQ(run(std::string("check --launches-in-flight 2 ") + rows).code, 2);
}
