#include "tests/reproduce/reproduce_fixture.h"

using namespace tetrace::test;

namespace {

class RivalsRun : public ReproduceTest {};

const std::string small = "rivals --size 16 --views 0 --samples 5 --backend openmp,embree ";

std::size_t rows_of(const nlohmann::json& result, const std::string& key, const std::string& value)
{
    std::size_t count = 0;
    for (const nlohmann::json& row : result.at("rows"))
        count += row.at(key) == value ? 1 : 0;
    return count;
}

} // namespace

TEST_F(RivalsRun, the_page_has_claims_scenes_and_rows_and_its_result_shows_it_again)
{
    const Ended ended = run(small + "--out page.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto page = result("page.json");
    const auto& tables = page.at("tables");
    const auto& claims = of_id(tables, "rivals").at("claims");
    EXPECT_GT(claims.size(), 30u);
    EXPECT_EQ(of_id(claims, "half32-over-our-bvh").at("verdict"), "not testable here") << "bunny was not traced";
    EXPECT_EQ(of_id(tables, "rivals-scenes").at("rows").size(), 3u) << "primary, diffuse and random rays on the host";
    EXPECT_EQ(of_id(tables, "rivals-rows").at("rows").size(), page.at("rows").size());
    EXPECT_EQ(rows_of(page, "schedule", "packets"), 3u);
    EXPECT_EQ(rows_of(page, "method", "maria"), 2u) << "its two forms, for primary rays only";
    EXPECT_GT(rows_of(page, "backend", "embree"), 0u);
    EXPECT_EQ(rows_of(page, "rays", "shadow"), 0u);
    ASSERT_TRUE(page.contains("pulses")) << "as bench has it";

    ASSERT_EQ(end(start("rivals --size 16 --views 0 --samples 5 --backend openmp --out page.md")).code, 0);
    const std::string markdown = read_text(folder_ / "page.md");
    EXPECT_NE(markdown.find("| claim | verdict | evidence |"), std::string::npos);
    EXPECT_NE(markdown.find("Embree, whose rays could be faster, has no rows in this run"), std::string::npos);
}

TEST_F(RivalsRun, a_layout_left_out_makes_no_claim_hold)
{
    ASSERT_EQ(run(small + "--layout half32,bvh2 --out page.json").code, 0);
    const nlohmann::json page = result("page.json");
    for (const nlohmann::json& claim : of_id(page.at("tables"), "rivals").at("claims"))
        EXPECT_NE(claim.at("verdict"), "holds") << claim.at("id");
}

TEST_F(RivalsRun, a_filter_leaves_rows_and_claims_about_the_others_are_not_testable)
{
    ASSERT_EQ(run(small + "--filter schedule:native --junit j.xml --out page.json").code, 0);
    const nlohmann::json page = result("page.json");
    EXPECT_GT(rows_of(page, "schedule", "native"), 2u) << "only this verb has rows of these forms";
    EXPECT_EQ(rows_of(page, "schedule", "native"), page.at("rows").size());
    const std::string claims = of_id(page.at("tables"), "rivals").at("claims").dump();
    EXPECT_NE(claims.find("--filter left out"), std::string::npos);
    EXPECT_EQ(claims.find("\"holds\""), std::string::npos);
    const std::string xml = read_text(folder_ / "j.xml");
    EXPECT_TRUE(contains(xml, "<testsuite name=\"tetrace reproduce cubes\""));
    for (const nlohmann::json& row : page.at("rows"))
        EXPECT_TRUE(contains(xml, "name=\"" + row.at("name").get<std::string>() + "\"")) << row.at("name");
}

TEST_F(RivalsRun, wrong_command_lines_are_refused)
{
    const auto refused = [&](const std::string& arguments, const std::string& text) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_NE(ended.errors.find(text), std::string::npos) << ended.errors;
    };
    refused("rivals --scene nothere", "nothere");
    refused("rivals,table6", "run it by itself");
    refused("rivals --resume", "name the result's file with --out");
    refused("rivals --shard 1/2 --out a.json", "--shard");
    refused("rivals --searches 10x32", "--searches");
    refused("rivals --out page.what", ".what");
}

TEST_F(RivalsRun, other_tables_measure_a_row_however_small_the_budget)
{
    const Ended ended = run("table6 --budget 0.0001 --size 16 --views 0-1281:600 --out t.json");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    const auto page = result("t.json");
    EXPECT_EQ(rows_of(page, "status", "ok"), 1u);
    EXPECT_EQ(rows_of(page, "status", "skipped"), page.at("rows").size() - 1);
}

TEST_F(RivalsRun, ranks_that_would_all_do_the_whole_run_are_refused)
{
    const ScopedVariable rank{"PMI_RANK", "1"}, size{"PMI_SIZE", "2"}, launch{"TETRACE_LAUNCH", "today"};
    const Ended ended = run(small + "--out page.json");
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.errors.find("rank 1 of 2"), std::string::npos) << ended.errors;
}
