// What implementations are expected to show: read, written, and what a check's rows are judged to be.
#include "bench/expectations/check_verdict.h"
#include "bench/expectations/expectation_files.h"
#include "bench/measuring/conformity.h"
#include "bench/output/junit.h"
#include "bench/output/row_fields.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Rows = std::vector<RowRecord>;

constexpr const char* driver = "driver-1.2";

/// A row of our kernel `method` on `tet80`: of a driver's device, bit for bit as openmp's.
RowRecord good_row(Method method = Method::maria, const std::string& scene = "cubes")
{
    RowRecord row;
    row.key = {scene, "vulkan", {}};
    row.key.kernel.method = method;
    row.device.name = "a device";
    row.device.usable = true;
    row.device.implementation = driver;
    row.self_test = SelfTest();
    Traced result;
    result.compared = true;
    row.outcome = result;
    return row;
}

RowRecord wrong(RowRecord row)
{
    std::get<Traced>(row.outcome).different = 12;
    return row;
}

RowRecord failed(RowRecord row)
{
    row.outcome = Failed{ErrorKind::driver, "device lost"};
    return row;
}

Expectations expecting(const Json& one)
{
    return {{driver, expectation_from(ResultValue(one, "x.json", "expectations"))}};
}

std::vector<std::string> names_of(const CheckJudgement& judgement)
{
    std::vector<std::string> names;
    for (const Judged& judged : judgement.rows)
        names.emplace_back(name_of(judged.judgement));
    return names;
}

std::vector<std::string> judged(const Rows& rows, const Json& expected)
{
    const Expectations expectations = expecting(expected);
    return names_of(judge_rows(rows, &expectations, false));
}

std::string verdict(const Rows& rows, const Expectations& expectations)
{
    return verdict_of(rows, judge_rows(rows, &expectations, false), {})->line().text();
}

class ExpectationFiles : public testing::Test {
protected:
    fs::path file(const char* name, const std::string& text)
    {
        write_file(folder_ / name, text);
        return folder_ / name;
    }
    Json json_at(const char* name) { return Json::parse(read_text(folder_ / name)); }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(ExpectationFiles, of_known_implementations_are_written_as_they_are_read)
{
    const Expectations all = read_expectations({TETRACE_EXPECTED_FOLDER});
    EXPECT_TRUE(all.contains("lavapipe-22.3"));
    EXPECT_FALSE(all.contains("inspect-radv-22.3")) << "those of compilers are of another form";
    for (const auto& [name, one] : all)
        EXPECT_EQ(expectation_json(one).dump(2) + "\n",
                  read_text(fs::path(TETRACE_EXPECTED_FOLDER) / (name + ".json")));
}

TEST_F(ExpectationFiles, with_a_mistake_are_refused_with_its_place)
{
    const std::pair<const char*, const char*> bad[] = {
        {"", "bad.json': it is empty"},
        {"{", "bad.json': it is not JSON, or was cut off"},
        {"[]", "bad.json': is not an object (array)"},
        {R"({"x-1": {"row": {}}})", "x-1.row: is not a key of an expectation, which may have self_test, rows,"},
        {R"({"rows": {"tiles": "fine"}})", "rows.tiles: is 'fine'; this tetrace knows reference, bit-exact"},
        {R"({"rows": {"tile": "wrong"}})", "rows.tile: is not a schedule"},
        {R"({"rows": {"tiles": "skipped"}})", "rows.tiles: 'skipped' cannot be expected"},
        {R"({"exceptions": {"cdt/maria/tet80": 3}})", "exceptions.cdt/maria/tet80: is not a text"},
        {R"({"self_test": {"denormals": true}})", "self_test.denormals: is not an item of the self-test"},
        {R"({"self_test": {"contracts": 1}})", "self_test.contracts: is not"},
        {R"({"self_test": {"exact": "yes"}})", "self_test.exact: is not"},
        {R"({"defects": {"loop": "seen"}})", "defects.loop: is 'seen'; this tetrace knows right, wrong, error"},
        {R"({"flakes": ["ok", "(" ]})", "flakes[1]: flakes: '(' is not a regular expression"},
        {R"({"flakes": [""]})", "flakes[0]: is empty"},
    };
    for (const auto& [text, message] : bad) {
        const std::string error = error_of([&] { static_cast<void>(read_expectations({file("bad.json", text)})); });
        EXPECT_TRUE(contains(error, message)) << text << ": " << error;
        EXPECT_TRUE(contains(error, "reading the expectations '")) << error;
    }
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(read_expectations({folder_ / "none.json"})); }),
                         "none.json': the file does not exist"));
}

TEST_F(ExpectationFiles, have_one_implementation_by_their_name_or_several_and_the_last_counts)
{
    file("one/driver-1.2.json", R"({"rows": {"tiles": "wrong"}})");
    file("all.json", R"({"driver-1.2": {"rows": {"tiles": "error"}}, "other-3": {"defects": {"loop": "wrong"}}})");
    const Expectations folder = read_expectations({folder_ / "one"});
    EXPECT_EQ(folder.at(driver).rows.at("tiles"), Finding::wrong);
    const Expectations both = read_expectations({folder_ / "one", folder_ / "all.json"});
    EXPECT_EQ(both.at(driver).rows.at("tiles"), Finding::error);
    EXPECT_EQ(both.at("other-3").defects.at("loop"), DefectFinding::wrong);
    Json section;
    set_expectations(section, both, {driver, "other-3"}, {}, {});
    EXPECT_EQ(section["expectations"]["files"], Json({(folder_ / "all.json").string()})) << "which counts for both";
    set_expectations(section, both, {"unmentioned-4"}, {}, {});
    EXPECT_EQ(section["expectations"]["files"], Json::array()) << "of what ran, no file says anything";
}

TEST_F(ExpectationFiles, keep_what_a_run_says_nothing_about)
{
    const fs::path path = file("all.json", R"({"driver-1.2": {"rows": {"tiles": "bit-exact"}, "flakes": ["a"],
        "exceptions": {"cdt/maria/tet80": "wrong", "cdt/maria/tet96": "wrong", "dragon/cdt/maria/tet80": "wrong"},
        "defects": {"loop": "wrong"}}, "other-3": {}})");
    static_cast<void>(ExpectationTarget(path).write(expectations_of({good_row()}, false)));
    const Json written = json_at("all.json")[driver];
    EXPECT_EQ(written["defects"]["loop"], "wrong");
    EXPECT_EQ(written["flakes"], Json({"a"}));
    EXPECT_EQ(written["exceptions"], Json({{"cdt/maria/tet96", "wrong"}, {"dragon/cdt/maria/tet80", "wrong"}}))
        << "the row is right now, and the others were not run";
    EXPECT_EQ(written["self_test"]["exact"], true);
    EXPECT_TRUE(json_at("all.json").contains("other-3"));

    Expectations defects;
    defects[driver].defects["loop"] = DefectFinding::right;
    static_cast<void>(ExpectationTarget(path).write(defects));
    EXPECT_EQ(json_at("all.json")[driver]["defects"]["loop"], "right");
    EXPECT_EQ(json_at("all.json")[driver]["rows"]["tiles"], "bit-exact");
}

TEST_F(ExpectationFiles, are_one_for_all_or_a_folder_of_one_for_each)
{
    const Expectations shown = expectations_of({good_row()}, false);
    EXPECT_EQ(ExpectationTarget(folder_ / "new/folder").write(shown),
              std::vector{folder_ / "new/folder/driver-1.2.json"});
    EXPECT_EQ(json_at("new/folder/driver-1.2.json")["rows"]["tiles"], "bit-exact");
    static_cast<void>(ExpectationTarget(folder_ / "driver-1.2.json").write(shown));
    EXPECT_EQ(json_at("driver-1.2.json"), json_at("new/folder/driver-1.2.json")) << "it names the implementation";
    static_cast<void>(ExpectationTarget(folder_ / "all.json").write(shown));
    EXPECT_EQ(json_at("all.json")[driver], json_at("driver-1.2.json"));
    file("file", "");
    EXPECT_TRUE(contains(error_of([&] { ExpectationTarget target(folder_ / "file"); }), "file' cannot be made"));
}

TEST(CheckJudgement, passes_what_is_known_and_fails_changes_in_either_direction)
{
    const RowRecord good = good_row(), bad = wrong(good), dead = failed(good);
    const Json one_wrong = {{"rows", {{"tiles", "bit-exact"}}}, {"exceptions", {{"cdt/maria/tet80", "wrong"}}}};
    using Names = std::vector<std::string>;
    EXPECT_EQ(judged({good, bad, dead}, Json::object()), Names({"conforms", "new failure", "new failure"}));
    EXPECT_EQ(judged({good, bad, dead}, one_wrong), Names({"unexpected pass", "known failure", "new failure"}));
    EXPECT_EQ(judged({good_row(Method::plane), wrong(good_row(Method::plane))}, one_wrong),
              Names({"conforms", "new failure"}));
    const Json all_dead = {{"rows", {{"tiles", "error"}}}};
    EXPECT_EQ(judged({good, bad, dead}, all_dead), Names({"unexpected pass", "unexpected pass", "known failure"}));
    RowRecord other = bad;
    other.device.implementation = "other-3";
    EXPECT_EQ(judged({other}, one_wrong), Names({"new failure"})) << "another implementation";
    RowRecord fast = bad;
    fast.key.kernel.math = MathMode::fast;
    EXPECT_EQ(judged({fast}, all_dead), Names({"new failure"})) << "schedules are of exact mode";
}

TEST(CheckJudgement, takes_an_exception_of_the_scene_before_that_of_all_scenes)
{
    const RowRecord on_cubes = good_row(), on_banana = wrong(good_row(Method::maria, "banana"));
    const Json of_banana = {{"exceptions", {{"banana/cdt/maria/tet80", "wrong"}, {"cdt/maria/tet80", "bit-exact"}}}};
    EXPECT_EQ(judged({on_cubes, on_banana}, of_banana), (std::vector<std::string>{"conforms", "known failure"}));
    const Expectations shown = expectations_of({on_cubes, on_banana}, false);
    EXPECT_EQ(expectation_json(shown.at(driver))["exceptions"], Json({{"banana/cdt/maria/tet80", "wrong"}}));
}

TEST(CheckJudgement, names_each_item_of_a_self_test_that_changed)
{
    RowRecord row = good_row();
    row.self_test->denormals_kept = false;
    row.self_test->division_ulps = 1;
    Json expected = {{"denormals_kept", true}, {"division_ulps", 3u}, {"exact", true}, {"text", "any"}};
    const Expectations expectations = expecting({{"self_test", expected}});
    const CheckJudgement judgement = judge_rows({row, good_row(Method::plane)}, &expectations, false);
    ASSERT_EQ(judgement.deviations.size(), 2u);
    EXPECT_EQ(judgement.deviations[0].name, "self_test/denormals_kept");
    EXPECT_EQ(judgement.deviations[0].judged.text(), "new failure: expected true, shows false");
    EXPECT_EQ(judgement.deviations[1].name, "self_test/division_ulps");
    EXPECT_EQ(judgement.deviations[1].judged.text(), "unexpected pass: expected 3, shows 1");
    EXPECT_EQ(exit_code({row, row}, judgement), 1);
    EXPECT_EQ(verdict({row}, expectations), "FAILED    1 new failure, 1 unexpected pass in 1 row on 1 device.\n");
    const std::string xml = junit_xml({row, row}, judgement);
    EXPECT_TRUE(contains(xml, "name=\"self_test\"")) << xml;
    EXPECT_TRUE(contains(xml, "self_test/denormals_kept: new failure: expected true, shows false")) << xml;
}

TEST(CheckJudgement, of_what_a_run_showed_passes_the_same_run_and_no_other)
{
    const Rows rows = {good_row(), wrong(good_row(Method::plane)), failed(good_row(Method::plucker))};
    const Expectations shown = expectations_of(rows, false);
    EXPECT_EQ(shown.at(driver).rows.at("tiles"), Finding::bit_exact);
    EXPECT_EQ(shown.at(driver).exceptions.size(), 2u);
    EXPECT_EQ(exit_code(rows, judge_rows(rows, &shown, false)), 0);
    EXPECT_EQ(verdict(rows, shown), "Conforms  3 rows on 1 device, 2 failures as expected.\n");
    EXPECT_TRUE(contains(junit_xml(rows, judge_rows(rows, &shown, false)), "failures=\"0\" errors=\"0\""));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Rows other = rows;
        other[i] = i == 0 ? wrong(rows[0]) : good_row(rows[i].key.kernel.method);
        EXPECT_EQ(exit_code(other, judge_rows(other, &shown, false)), 1) << i;
    }
}

TEST(CheckJudgement, of_segments_names_rows_that_there_are)
{
    RowRecord row = wrong(good_row(Method::project));
    row.key.kernel.task = Task::segments;
    row.key.rays = RayKind::random;
    Rows rows = {row, good_row()};
    for (RowRecord& one : rows)
        one.key.backend = reference_backend().name();
    const Expectations shown = expectations_of(rows, false);
    EXPECT_EQ(exit_code(rows, judge_rows(rows, &shown, false)), 0);
    EXPECT_EQ(names_of_no_row(shown.at(driver), reference_backend()), std::vector<std::string>());
    Expectation other = shown.at(driver);
    other.exceptions = {{"segments/project/tet80/shadow", Finding::wrong}};
    EXPECT_EQ(names_of_no_row(other, reference_backend()).size(), 1u) << "task segments lacks shadow rays";
}

TEST(CheckJudgement, of_wrong_rows_alone_expects_other_rows_to_conform)
{
    const Rows rows = {wrong(good_row())};
    const Expectations shown = expectations_of(rows, false);
    EXPECT_TRUE(shown.at(driver).rows.empty());
    const Rows other = {wrong(good_row(Method::plane))};
    EXPECT_EQ(exit_code(other, judge_rows(other, &shown, false)), 1);
}

TEST(CheckJudgement, of_a_required_row_that_is_expected_to_be_unsupported_passes)
{
    RowRecord row = good_row(Method::plane);
    row.outcome = Skipped{Status::unsupported, "buffers are too small"};
    const Rows rows = {good_row(), row};
    const auto text = [&](const Json& expected) {
        const Expectations expectations = expecting(expected);
        return verdict_of(rows, judge_rows(rows, &expectations, false), {"vulkan"})->line().text();
    };
    EXPECT_EQ(text({{"exceptions", {{"cdt/plane/tet80", "unsupported"}}}}), "Conforms  2 rows on 1 device.\n");
    EXPECT_EQ(text(Json::object()), "FAILED    1 row without a result in 2 rows on 1 device.\n");
    EXPECT_EQ(text({{"rows", {{"tiles", "bit-exact"}}}}), "FAILED    1 new failure in 2 rows on 1 device.\n");
    EXPECT_EQ(verdict(rows, expecting(Json::object())), "Conforms  1 row on 1 device; 1 more has no result.\n");
}

TEST(CheckJudgement, reports_names_and_self_tests_that_the_run_cannot_have)
{
    RowRecord untested = good_row();
    untested.self_test.reset();
    const Expectations expectations = expecting({{"self_test", {{"exact", true}}},
                                                 {"exceptions",
                                                  {{"cdt/maria/tet80", "bit-exact"},
                                                   {"banana/cdt/maria/tet80/shadow", "wrong"},
                                                   {"cdt/maria/tet80/packets", "wrong"},
                                                   {"cdt/marja/tet80", "wrong"}}}});
    const auto unknown = unknown_of(judge_rows({untested, untested}, &expectations, false));
    ASSERT_EQ(unknown.size(), 3u);
    EXPECT_TRUE(contains(unknown[0], "cdt/maria/tet80/packets: no row of vulkan has this name")) << unknown[0];
    EXPECT_TRUE(contains(unknown[1], "cdt/marja/tet80: no row of vulkan has this name")) << unknown[1];
    EXPECT_TRUE(contains(unknown[2], "self_test: no row of this run on vulkan has one")) << unknown[2];
    EXPECT_EQ(unknown_of(judge_rows({good_row()}, &expectations, false)).size(), 2u);
    Json section;
    set_expectations(section, expectations, {}, {}, {}, unknown);
    EXPECT_TRUE(contains(expectation_lines(ResultValue(section, "r.json")).text(), "cdt/marja/tet80"));
}

TEST(CheckJudgement, reports_implementations_that_no_file_mentions_once)
{
    RowRecord openmp = good_row();
    openmp.key.backend = openmp.device.implementation = "openmp";
    const Expectations expectations = expecting(Json::object());
    const CheckJudgement judgement = judge_rows({openmp, good_row(), openmp}, &expectations, false);
    EXPECT_EQ(unmentioned_of(judgement), std::vector<std::string>{"openmp"});
}

TEST(Repetitions, that_differ_fail_with_their_rate_unless_they_are_known_flakes)
{
    const RowRecord good = good_row(), bad = wrong(good);
    const Rows rows = combined_rows({{good, bad}, {bad, bad}, {good, bad}}, false);
    EXPECT_EQ(rate_text(rows[0]), "wrong in 1 of 3");
    EXPECT_EQ(conformity_text(rows[0]), "wrong: 12 rays, in 1 of 3");
    EXPECT_EQ(rate_text(rows[1]), "") << "it always fails";
    const Expectations none = expecting(Json::object());
    const CheckJudgement judgement = judge_rows(rows, &none, false);
    EXPECT_EQ(names_of(judgement), (std::vector<std::string>{"new failure", "new failure"}));
    EXPECT_TRUE(contains(junit_xml(rows, judgement), "expected conforms, shows wrong in 1 of 3"));

    const Expectations shown = expectations_of({rows[0]}, false);
    ASSERT_EQ(shown.at(driver).flakes.size(), 1u);
    EXPECT_TRUE(shown.at(driver).exceptions.empty());
    EXPECT_EQ(verdict({rows[0]}, shown), "Conforms  1 row on 1 device, 1 known flake.\n");
    EXPECT_EQ(verdict({good}, shown), "Conforms  1 row on 1 device.\n");
    EXPECT_EQ(verdict({bad}, shown), "Conforms  1 row on 1 device, 1 known flake.\n");
    const Rows other = {wrong(good_row(Method::maria, "banana"))};
    EXPECT_EQ(exit_code(other, judge_rows(other, &shown, false)), 1) << "the flake is another row";
}

TEST(Repetitions, with_other_bits_each_time_are_flakes_though_all_are_right)
{
    RowRecord other = good_row();
    std::get<Traced>(other.outcome).views_hash = 7;
    const Rows rows = combined_rows({{good_row()}, {other}, {good_row()}, {other}}, false);
    EXPECT_EQ(rate_text(rows[0]), "other answers in 2 of 4");
    EXPECT_EQ(exit_code(rows, judge_rows(rows, nullptr, false)), 1);
}

TEST(Repetitions, are_in_the_results_and_read_again)
{
    const Rows rows = combined_rows({{good_row()}, {wrong(good_row())}}, false);
    const Json json = row_json(RowFacts(rows[0]));
    EXPECT_EQ(json["repeated"], Json({"bit-exact", "wrong"}));
    EXPECT_FALSE(row_json(RowFacts(good_row())).contains("repeated"));
}
