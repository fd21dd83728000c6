#include "tests/reproduce/journal_lines.h"
#include "tests/reproduce/reproduce_fixture.h"

using namespace tetrace::test;

namespace {

class LadderRun : public ReproduceTest {};

const std::string lattices = "ladder --scene lattice:6,lattice:12 --size 48 --samples 5 --backend openmp,cuda-host ";

} // namespace

TEST_F(LadderRun, every_row_has_its_size_its_steps_and_both_costs_and_they_are_printed)
{
    const Ended ended = run(lattices + "--out page.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto page = result("page.json");
    const auto& rows = of_id(page.at("tables"), "ladder").at("rows");
    ASSERT_EQ(rows.size(), 2u * 2 * 3) << "scenes, devices, layouts";
    EXPECT_EQ(rows.size(), page.at("rows").size()) << "as bench has them";
    for (const nlohmann::json& row : rows) {
        EXPECT_EQ(row.at("status"), "ok") << row;
        EXPECT_GT(row.at("full_ns").at("value"), 0) << row;
        EXPECT_GT(row.at("steps_per_ray"), 1) << row;
        EXPECT_GE(row.at("rounds"), 1) << row;
        EXPECT_EQ(row.at("step"), contains(row.at("row").get<std::string>(), "bvh") ? "node" : "tet");
    }
    EXPECT_GT(rows.back().at("megabytes"), 0);
    EXPECT_GT(of_id(page.at("figures"), "ladder-openmp").at("series").size(), 2u);
    EXPECT_GT(of_id(page.at("figures"), "ladder-cuda-host").at("series").size(), 2u);
    EXPECT_TRUE(contains(ended.out, "ns/step")) << ended.out;
}

TEST_F(LadderRun, scenes_without_memory_or_time_are_left_out_with_the_reason)
{
    ASSERT_EQ(run("ladder --scene lattice:4,lattice:563 --size 16 --samples 5 --out a.json").code, 0);
    const auto no_memory = result("a.json").at("missing_scenes");
    ASSERT_EQ(no_memory.size(), 1u);
    EXPECT_TRUE(
        contains(no_memory[0].get<std::string>(), "lattice:563 is left out: making and packing it takes about"));
    ASSERT_EQ(run("ladder --scene lattice:4,lattice:5 --size 16 --samples 5 --budget 0.001 --out b.json").code, 0);
    const auto no_time = result("b.json").at("missing_scenes");
    ASSERT_EQ(no_time.size(), 1u);
    EXPECT_TRUE(contains(no_time[0].get<std::string>(), "lattice:5 is left out: making and verifying it takes about"));
}

TEST_F(LadderRun, goes_on_after_the_scenes_of_its_journal)
{
    const std::string ladder = "ladder --scene lattice:4,lattice:5 --size 16 --samples 5 --out r.json";
    const Ended ended = end(start(ladder, 2, SIGINT)); // after the head and a scene
    ASSERT_EQ(ended.code, 130) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "--resume")) << ended.errors;
    const auto before = result("r.json");
    EXPECT_TRUE(before.at("interrupted").get<bool>());
    EXPECT_EQ(run(ladder).code, 2) << "a run that did not end is not replaced";
    ASSERT_EQ(run(ladder + " --resume").code, 0);
    const auto after = result("r.json");
    const auto rows_of = [](const nlohmann::json& all, const std::string& scene) {
        nlohmann::json rows;
        for (const auto& row : all.at("rows"))
            if (row.at("scene") == scene) rows.push_back(row);
        return rows;
    };
    EXPECT_EQ(rows_of(after, "lattice:4").size(), 3u);
    EXPECT_EQ(rows_of(after, "lattice:5").size(), 3u);
    EXPECT_EQ(rows_of(before, "lattice:5"), nlohmann::json()) << "not begun";
    const auto &cells = of_id(after.at("tables"), "ladder").at("rows"),
               &earlier = of_id(before.at("tables"), "ladder").at("rows");
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(rows_of(after, "lattice:4")[i].at("times"), rows_of(before, "lattice:4")[i].at("times"));
        EXPECT_EQ(cells.at(i), earlier.at(i)) << "with what single rays cost";
    }
    const auto readings = after.at("pulses").at(0).at("readings");
    EXPECT_TRUE(std::ranges::is_sorted(readings)) << readings;
    const std::string journal = read_text(folder_ / "r.json.journal");
    EXPECT_EQ(run(ladder + " --resume").code, 0);
    const auto again = result("r.json");
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(again.at("rows").at(i).at("times"), after.at("rows")[i].at("times")) << "only from the journal";
    for (const std::string part : {"/extra/costs/0", "/tetrace/samples_a_row", "/extra"}) {
        auto entries = entries_of(journal);
        entries.at(2) = entries[2].patch({{{"op", "remove"}, {"path", part}}});
        write_file(folder_ / "r.json.journal", journal_of(entries));
        const Ended damaged = run(ladder + " --resume");
        EXPECT_EQ(damaged.code, 2) << part << damaged.errors;
        EXPECT_TRUE(contains(damaged.errors, "lattice:5 in the journal is damaged: ")) << damaged.errors;
    }
}

TEST_F(LadderRun, wrong_command_lines_are_refused)
{
    const auto refused = [&](const std::string& arguments, const std::string& text) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 2) << arguments;
        EXPECT_NE(ended.errors.find(text), std::string::npos) << ended.errors;
    };
    refused("ladder,table6", "run it by itself");
    refused("ladder --views 0-3", "--views is not for 'reproduce ladder'");
    refused("ladder --shard 1/2 --out a.json", "--shard");
}
