#include "bench/reproduce/flat_tets.h"
#include "tests/reproduce/embree_rows.h"
#include "tests/reproduce/journal_lines.h"
#include "tests/reproduce/reproduce_fixture.h"

using namespace tetrace;
using namespace tetrace::test;
using nlohmann::json;

namespace {

class Reproduce : public ReproduceTest {};

const json& claim(const json& table, const std::string& id)
{
    for (const json& one : table.at("claims"))
        if (one.at("id") == id) return one;
    throw std::runtime_error("no claim " + id);
}

} // namespace

TEST_F(Reproduce, table4_of_a_sample_of_views)
{
    const Ended ended = run("table4 --method maria --size 24 --views 0-1281:100 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    EXPECT_EQ(section["verb"], "reproduce");
    const json table = of_id(section["tables"], "table4");
    ASSERT_EQ(table["rows"].size(), 2u) << "tet80 and tet96";
    for (const json& row : table["rows"]) {
        EXPECT_EQ(row["scene"], "cubes");
        EXPECT_EQ(row["method"], "maria");
        EXPECT_EQ(row["status"], "ok");
        EXPECT_EQ(row["views"]["value"], 13);
        EXPECT_EQ(row["flawed"]["value"], 0);
        EXPECT_FALSE(row["flawed"].contains("paper")) << "it does not have this scene";
        EXPECT_EQ(row["likeness"], "not its scene");
        EXPECT_FALSE(row["flawed"].contains("high")) << "none in a sample bounds nothing";
    }
    for (const json& column : table["columns"])
        EXPECT_EQ(column.value("decimals", -1) == 0, column["key"] == "views") << column;
    EXPECT_EQ(claim(table, "maria-has-no-wrong-result")["verdict"], "not testable here");
    EXPECT_EQ(claim(table, "maria-has-the-fewest")["verdict"], "not testable here") << "nothing to compare with";
    EXPECT_EQ(claim(table, "project-has-no-wrong-result")["verdict"], "not testable here") << "it was not traced";
    EXPECT_EQ(section["rows"][0]["verification"]["rays"], 13 * 24 * 24);
    EXPECT_FALSE(section["rows"][0].contains("rates")) << "nothing was timed";
    EXPECT_TRUE(contains(ended.out, "table4: Rays with a wrong result"));
}

TEST_F(Reproduce, table4_has_every_method_where_none_is_named_and_none_wrong_of_project)
{
    const Ended ended = run("table4 --layout tet80 --size 24 --views 0-1281:100 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json table = of_id(result("r.json")["tables"], "table4");
    ASSERT_EQ(table["rows"].size(), 6u);
    const json row = table["rows"][5];
    EXPECT_EQ(row["method"], "project");
    EXPECT_EQ(row["status"], "ok");
    EXPECT_EQ(row["flawed"]["value"], 0);
    EXPECT_FALSE(row["flawed"].contains("paper")) << "it does not have this method";
    EXPECT_TRUE(contains(claim(table, "project-has-no-wrong-result")["evidence"], "0 of 7,488 rays in 13 of 1,282"));
}

TEST_F(Reproduce, all_views_of_smaller_images_are_a_sample_still)
{
    const Ended ended = run("table4 --method maria --layout tet80 --size 4 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json table = result("r.json")["tables"][0];
    EXPECT_EQ(table["rows"][0]["views"]["value"], 1282);
    EXPECT_EQ(claim(table, "maria-has-no-wrong-result")["verdict"], "not testable here");
}

TEST_F(Reproduce, figure6_has_a_point_a_view_and_pictures_of_the_extremes)
{
    const Ended ended =
        run("figure6 --method maria --layout tet80 --size 64 --samples 3 --views 0-1281:60 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    const json figure = of_id(section["figures"], "figure6-cubes-cpu");
    EXPECT_EQ(figure["series"][0]["name"], "maria") << "the one layout and device go without saying";
    ASSERT_EQ(figure["series"].size(), 1u);
    EXPECT_EQ(figure["series"][0]["points"].size(), 22u);
    for (const json& point : figure["series"][0]["points"])
        EXPECT_GT(point[1].get<double>(), 0);
    EXPECT_EQ(figure["pictures"].size(), 4u);
    for (const json& name : figure["pictures"])
        EXPECT_TRUE(std::filesystem::exists(folder_ / name.get<std::string>())) << name;
    const json row = of_id(section["tables"], "figure6")["rows"][0];
    EXPECT_LE(row["correlation"]["low"], row["correlation"]["value"]);
    EXPECT_LT(row["fewest_tets"]["value"], row["most_tets"]["value"]);
    EXPECT_FALSE(row["fewest_tets"].contains("paper")) << "it does not trace this scene";
    EXPECT_EQ(section["rows"][0]["times"]["samples_s"].size(), 3u);
    EXPECT_GT(section["rows"][0]["rates"]["mrays_per_s"], 0);
    EXPECT_EQ(claim(of_id(section["tables"], "figure6"), "time-is-proportional-to-tets-gpu")["verdict"],
              "not testable here");
}

TEST_F(Reproduce, figure6_draws_an_emulated_device_apart_from_the_processor)
{
    const Ended ended = run("figure6 --method maria,ms06 --layout tet80 --backend openmp,cuda-host --size 16 "
                            "--samples 3 --views 0-3 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json figures = result("r.json")["figures"];
    ASSERT_EQ(figures.size(), 2u);
    for (const char* const id : {"figure6-cubes-cpu", "figure6-cubes-emulated"}) {
        const json figure = of_id(figures, id);
        ASSERT_EQ(figure["series"].size(), 2u) << id;
        EXPECT_EQ(figure["series"][0]["name"], "ms06");
        EXPECT_EQ(figure["series"][1]["name"], "maria");
    }
    EXPECT_EQ(figures[0]["pictures"].size(), 4u);
    EXPECT_EQ(figures[1]["pictures"].size(), 0u) << "they are the scene's";
    EXPECT_EQ(figures[0]["notes"].size(), figures[1]["notes"].size() + 1) << "which reports them";
}

TEST_F(Reproduce, table3_has_the_scenes_counts_and_a_rate_a_row)
{
    const Ended ended = run("table3 --method maria --size 24 --samples 3 --views 0,1 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    const json scenes = of_id(section["tables"], "table3")["rows"];
    ASSERT_EQ(scenes.size(), 1u) << "TetGen does not make this scene: it lacks a paper's build";
    EXPECT_EQ(scenes[0]["tets"]["value"], 6 * 6 * 6 * 6);
    EXPECT_LT(scenes[0]["tet80_mib"]["value"], scenes[0]["tet96_mib"]["value"]);
    const json rates = of_id(section["tables"], "table3-rates")["rows"];
    ASSERT_EQ(rates.size(), 2u);
    EXPECT_GT(rates[0]["mrays_per_s"]["value"], 0);
}

TEST_F(Reproduce, table3_has_a_papers_build_only_of_the_papers_scenes)
{
    const std::string octahedron = "OFF\n6 8 0\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n"
                                   "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";
    for (const char* const name : {"dragon.off", "armadillo.off"})
        write_file(folder_ / name, octahedron);
    const Ended ended = run("table3 --scene dragon.off,armadillo.off --method maria --layout tet80 --size 8 "
                            "--samples 3 --views 0 --out r.json");
    ASSERT_TRUE(ended.code == 0 || ended.code == 3) << ended.errors; // 3: no TetGen is built here
    const json table = of_id(result("r.json")["tables"], "table3");
    ASSERT_EQ(table["claims"].size(), 1u);
    EXPECT_EQ(table["claims"][0]["id"], "armadillo-has-the-papers-counts");
    EXPECT_EQ(table["claims"][0]["verdict"], "not testable here");
    if (ended.code == 0) {
        EXPECT_TRUE(contains(table["claims"][0]["evidence"], "Another mesh: 8 triangles, but the paper's counts are "
                                                             "from 345,944"));
        EXPECT_EQ(table["rows"].back()["tets_kind"], "rays");
        EXPECT_FALSE(table["rows"].back()["tets"].contains("paper")) << "it lacks tets for rays";
        const json row = table["rows"][3];
        EXPECT_EQ(row["tets_kind"], "cdt");
        EXPECT_EQ(row["likeness"], "other mesh");
        EXPECT_EQ(row["switches"], "-pq8/4");
        EXPECT_EQ(row["tets"]["paper"], 2'990'552);
        EXPECT_FALSE(row["tets"].contains("ratio")) << "of another mesh it means nothing";
    }
    const json rates = of_id(result("r.json")["tables"], "table3-rates")["rows"];
    ASSERT_EQ(rates.size(), 5u);
    EXPECT_EQ(rates[1]["scene"], "dragon");
    EXPECT_EQ(rates[1]["build"], "rays");
    EXPECT_EQ(rates[2]["build"], "ours");
    EXPECT_EQ(rates[3]["build"], "paper's");
    EXPECT_EQ(rates[4]["build"], "rays");
}

TEST_F(Reproduce, builds_choose_those_that_a_scene_has)
{
    const std::string octahedron = "OFF\n6 8 0\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n"
                                   "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";
    for (const char* const name : {"dragon.off", "armadillo.off"})
        write_file(folder_ / name, octahedron);
    const std::string common = "table4 --scene dragon.off,armadillo.off --method maria --layout tet80 --size 8 "
                               "--views 0-3 --out r.json";
    const auto builds = [&](const std::string& option) {
        const Ended ended = run(common + option);
        EXPECT_TRUE(ended.code == 0 || ended.code == 3) << ended.errors; // 3: no TetGen is built here
        const json section = result("r.json"), rows = of_id(section["tables"], "table4")["rows"];
        std::string text;
        for (const json& row : rows)
            text += row["scene"].get<std::string>() + ' ' + row["build"].get<std::string>() + "; ";
        if (ended.code == 0 && option == " --builds paper") {
            EXPECT_EQ(section["scenes"].back()["likeness"]["kind"], "other mesh");
            EXPECT_EQ(section["scenes"].back()["likeness"]["compared"], false);
            EXPECT_FALSE(section["scenes"].front().contains("likeness"));
            const json walk = section["scenes"].back()["start_walk"];
            EXPECT_EQ(walk["walked"].get<int>() + walk["located"].get<int>(), 4) << "the wide domain's cameras";
            EXPECT_FALSE(section["scenes"].front().contains("start_walk")) << "the tight one's are outside";
        }
        return text;
    };
    EXPECT_EQ(builds(""), "dragon ours; dragon rays; armadillo ours; armadillo paper's; armadillo rays; ");
    EXPECT_EQ(builds(" --builds paper"), "dragon ours; armadillo paper's; ");
    EXPECT_EQ(builds(" --builds ours"), "dragon ours; armadillo ours; ");
    EXPECT_EQ(builds(" --builds rays"), "dragon rays; armadillo rays; ");
    EXPECT_EQ(builds(" --builds rays --scene cubes"), "dragon rays; armadillo rays; cubes ours; ");
}

TEST_F(Reproduce, table6_has_maria_and_the_bvhs_and_no_other_table_has_them)
{
    const std::string common = " --backend openmp,embree --layout tet80 --size 16 --samples 3 --views 0-1281:120 ";
    const Ended ended = run("table6 --out r.json" + common);
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    ASSERT_EQ(section["rows"].size(), 4 + embree_rows())
        << "only maria of the methods, bvh2, bvh4, cwbvh, and Embree's";
    ASSERT_EQ(of_id(section["tables"], "table6")["rows"].size(), 4 + embree_rows());
    ASSERT_EQ(of_id(section["tables"], "table6-pairs")["rows"].size(), 3 + traced_embree_rows());
    const json pairs = of_id(section["tables"], "table6-pairs")["rows"];
    for (const json& row : pairs)
        EXPECT_TRUE(row["ratio"].contains("low"));
    EXPECT_EQ(of_id(section["figures"], "table6-cubes-cpu")["series"].size(), 4 + traced_embree_rows());
    const Ended both = run("table6,figure6 --method stp,maria,single --out b.json" + common);
    ASSERT_EQ(both.code, 0) << both.errors;
    EXPECT_EQ(result("b.json")["rows"].size(), 7u) << "stp, maria, and single of our BVHs and two of Embree's";
    EXPECT_EQ(of_id(result("b.json")["tables"], "figure6")["rows"].size(), 2u);
    EXPECT_EQ(of_id(result("b.json")["tables"], "table6")["rows"].size(), 6u);
}

TEST_F(Reproduce, table6_is_the_same_again_from_its_journal_build_times_too)
{
    const std::string arguments = "table6 --backend openmp,embree --size 8 --samples 3 --views 0-2 --out r.json";
    ASSERT_EQ(run(arguments).code, 0);
    const json before = result("r.json");
    ASSERT_EQ(run(arguments + " --resume").code, 0);
    EXPECT_EQ(result("r.json")["tables"], before["tables"]);
    EXPECT_EQ(result("r.json")["figures"], before["figures"]);
    std::vector<json> journal = entries_of(read_text(folder_ / "r.json.journal"));
    const auto entry = std::ranges::find_if(journal, [](const json& one) { return one.contains("setup"); });
    ASSERT_NE(entry, journal.end());
    (*entry)["build_s"] = -1.0;
    write_file(folder_ / "r.json.journal", journal_of(journal));
    EXPECT_TRUE(contains(run(arguments + " --resume").errors, "a build time in the journal is damaged"));
}

TEST_F(Reproduce, table5_has_every_search_of_every_method_without_a_scene)
{
    const Ended ended = run("table5 --searches 40x64 --samples 3 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    EXPECT_TRUE(section["scenes"].empty());
    EXPECT_TRUE(section["missing_scenes"].empty());
    EXPECT_EQ(section["devices"].size(), 1u) << "compare and report read them";
    const json table = of_id(section["tables"], "table5");
    ASSERT_EQ(table["rows"].size(), 12u) << "six methods, two layouts, one thread";
    for (const json& row : table["rows"]) {
        EXPECT_EQ(row["device"], "openmp, 1 thread");
        EXPECT_EQ(row["threads"]["value"], 1);
        EXPECT_EQ(row["searches"]["value"], 40 * 64);
        EXPECT_EQ(row["faces"], "reference");
        EXPECT_NEAR(row["ns_a_search"]["value"].get<double>() * row["msearches_per_s"]["value"].get<double>(), 1e3,
                    1e-6);
        EXPECT_GT(row["copy_percent"]["value"].get<double>(), 0);
        if (row["method"] == "maria") {
            EXPECT_EQ(row["wrong"]["value"], 0);
            EXPECT_EQ(row["lost"]["value"], 0);
        }
    }
    EXPECT_EQ(claim(table, "table5-maria-exact")["verdict"], "not testable here") << "a part of the paper's searches";
    EXPECT_TRUE(contains(claim(table, "table5-maria-exact")["evidence"], "5,120 searches by 2 rows: 0 wrong"));
    for (const json& row : table["rows"])
        EXPECT_EQ(row["all_ms"].contains("paper"), row["method"] != "project");
    const json operations = of_id(section["tables"], "operations");
    EXPECT_EQ(operations["rows"].size(), 6u);
    EXPECT_EQ(claim(operations, "maria-takes-28-operations")["verdict"], "holds");
    EXPECT_TRUE(contains(claim(table, "table5-maria-fastest-cpu")["evidence"], "plane / maria"));
    EXPECT_TRUE(contains(claim(table, "table5-plucker-overtakes-stp-gpu")["evidence"], "No row of a GPU"));
    EXPECT_EQ(lines("r.json.journal"), 1u + 20 + 1 + 1) << "head, batches, yardstick, end";
}

TEST_F(Reproduce, table5_measures_the_rows_that_fit_the_budget_and_names_the_others)
{
    const auto rows = [&](const std::string& more) {
        const Ended ended = run("table5 --searches 20x64 --samples 3 --out r.json --budget " + more);
        EXPECT_EQ(ended.code, 0) << ended.errors;
        return result("r.json")["searches"]["rows"];
    };
    const auto measured = [](const json& of) {
        return std::ranges::count_if(of, [](const json& row) { return row["status"] == "ok"; });
    };
    const json few = rows("0.0001");
    EXPECT_EQ(few.size(), 12u);
    EXPECT_EQ(measured(few), 1) << "however small the budget";
    for (const json& row : few) {
        if (row["status"] == "ok") {
            EXPECT_EQ(row["verification"]["searches"], 20 * 64) << "all of them";
            continue;
        }
        EXPECT_EQ(row["status"], "skipped");
        EXPECT_TRUE(contains(row["reason"].get<std::string>(), "--budget")) << row["reason"];
    }
    const json again = rows("0.0001 --resume");
    for (std::size_t i = 0; i < few.size(); ++i)
        EXPECT_EQ(again.at(i)["status"], few.at(i)["status"]) << "nothing is measured that was skipped";
    EXPECT_EQ(measured(rows("1h")), 12);
}

TEST_F(Reproduce, table5_records_what_it_was_made_from)
{
    const Ended ended = run("table5 --searches 40x64 --method maria --layout tet80 --samples 3 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    EXPECT_EQ(section["samples_a_row"], 3);
    EXPECT_EQ(section["searches"]["tets"], 40);
    EXPECT_EQ(section["searches"]["rays_a_tet"], 64);
    EXPECT_EQ(section["searches"]["batches"], 20);
    ASSERT_EQ(section["searches"]["rows"].size(), 1u);
    const json row = section["searches"]["rows"][0];
    EXPECT_EQ(row["name"], "search/maria/tet80/random-tets/math:exact/api:openmp/threads:1");
    EXPECT_EQ(row["status"], "ok");
    EXPECT_EQ(row["host_threads"], 1);
    EXPECT_EQ(row["times"]["clock"], "host steady clock");
    EXPECT_EQ(row["times"]["samples_s"].size(), 3u);
    EXPECT_EQ(row["batch_medians_s"].size(), 20u);
    EXPECT_EQ(row["face_hash"].get<std::string>().size(), 16u);
    EXPECT_EQ(row["verification"]["searches"], 40 * 64);
    EXPECT_EQ(row["verification"]["wrong"], 0);
    const json table = of_id(section["tables"], "table5");
    EXPECT_EQ(row["msearches_per_s"], table["rows"][0]["msearches_per_s"]["value"]);
}

TEST_F(Reproduce, samples_a_row_are_none_where_nothing_is_timed)
{
    ASSERT_EQ(run("table4 --method maria --layout tet80 --size 8 --views 0 --samples 7 --out r.json").code, 0);
    EXPECT_EQ(result("r.json")["samples_a_row"], 0);
    EXPECT_FALSE(result("r.json").contains("searches"));
}

TEST_F(Reproduce, each_table_has_the_rows_that_a_filter_keeps_and_junit_their_verdicts)
{
    for (const char* const table : {"table3", "table4", "table5", "table6", "figure6"}) {
        const Ended ended = run(std::string(table) + " --searches 20x8 --size 16 --views 0-1281:600 --samples 3 "
                                                     "--filter maria/tet80 --junit j.xml --out r.json");
        ASSERT_EQ(ended.code, 0) << table << ended.errors;
        const nlohmann::json all = result("r.json");
        const nlohmann::json& rows = all.contains("searches") ? all.at("searches").at("rows") : all.at("rows");
        ASSERT_FALSE(rows.empty()) << table;
        const std::string xml = read_text(folder_ / "j.xml");
        for (const nlohmann::json& row : rows) {
            const std::string name = row.at("name");
            EXPECT_TRUE(contains(name, "maria/tet80")) << table << ": " << name;
            EXPECT_TRUE(contains(xml, "name=\"" + name + "\"")) << table << ": " << name;
        }
        EXPECT_TRUE(contains(xml, "failures=\"0\" errors=\"0\"")) << xml;
    }
    const Ended none = run("table4 --size 16 --views 0 --filter nothing --junit j.xml");
    EXPECT_EQ(none.code, 2);
    EXPECT_TRUE(contains(none.errors, "--filter 'nothing' matches none of the")) << none.errors;
    EXPECT_TRUE(contains(read_text(folder_ / "j.xml"), "errors=\"1\"")) << "as of any run without a result";
}

TEST_F(Reproduce, refuses_what_it_does_not_make)
{
    const Ended unknown = run("table9");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_TRUE(contains(unknown.errors, "table3, table4, table5, table6, figure6, rivals, ladder or volume"));
    const Ended no_maria = run("table6 --method stp");
    EXPECT_EQ(no_maria.code, 2);
    EXPECT_TRUE(contains(no_maria.errors, "table6 compares maria with BVHs: add it to --method"));
    EXPECT_TRUE(contains(run("table4 --resume").errors, "--out"));
}

TEST_F(Reproduce, as_csv_and_markdown)
{
    const std::string arguments = "table4 --method maria --layout tet80 --size 24 --views 0,1 --format ";
    const Ended csv = run(arguments + "csv");
    ASSERT_EQ(csv.code, 0) << csv.errors;
    EXPECT_EQ(
        csv.out.rfind(
            "table,scene,build,method,layout,device,quantity,unit,value,low,high,paper,ratio,x,verdict,text\n", 0),
        0u);
    EXPECT_TRUE(contains(csv.out, "table4,cubes,ours,maria,tet80,openmp,flawed,rays per image,0,0,"));
    EXPECT_TRUE(contains(csv.out, "table4,cubes,ours,maria,tet80,openmp,status,,,,,,,,,ok\n"));
    EXPECT_TRUE(contains(csv.out, "table4,,,,,,maria-has-no-wrong-result,,,,,,,,not testable here,"));
    const Ended searches = run("table5 --searches 20x8 --method maria --layout tet96 --format csv");
    EXPECT_TRUE(contains(searches.out, "table5,,,maria,tet96,\"openmp, 1 thread\",searches,,160,"));
    EXPECT_TRUE(contains(searches.out, "table5,,,maria,tet96,\"openmp, 1 thread\",wrong,per million,0,"));
    const Ended markdown = run(arguments + "markdown");
    EXPECT_TRUE(contains(markdown.out, "## table4: Rays with"));
    EXPECT_TRUE(contains(markdown.out, "| maria has no wrong result | not testable here |"));
}

TEST(FlatTets, flatness_is_the_shortest_altitude_over_the_longest_edge)
{
    TetMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25f, 0.25f, 1e-4f}};
    mesh.tets = {{{0, 1, 2, 3}, {}, {}}, {{0, 1, 2, 4}, {}, {}}};
    // The corner of a cube: volume 1/6, largest face sqrt(3)/2, longest edge sqrt(2).
    EXPECT_NEAR(flatness(mesh, 0), 1 / std::sqrt(3.0) / std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(flatness(mesh, 1), 1e-4 / std::sqrt(2.0), 1e-9);
    EXPECT_LT(flatness(mesh, 1), flat_below);
}
