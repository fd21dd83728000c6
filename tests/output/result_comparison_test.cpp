#include "bench/results/result_comparison.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Json = nlohmann::json;

/// Ten samples around that many seconds, 0.1 % apart.
Json samples_around(double seconds)
{
    Json samples = Json::array();
    for (int i = 0; i < 10; ++i)
        samples.push_back(seconds * (1 + 0.001 * i));
    return samples;
}

Json timed_row(const char* name, double seconds)
{
    return {{"name", name},
            {"scene", "cubes"},
            {"backend", "openmp"},
            {"status", "ok"},
            {"hit_hash", "00000000000000ff"},
            {"times", {{"samples_s", samples_around(seconds)}}}};
}

Json untimed_row(const char* name, const char* status)
{
    return {{"name", name}, {"scene", "cubes"}, {"backend", "openmp"}, {"status", status}, {"reason", "the reason"}};
}

Json scene()
{
    return {{"name", "cubes"}, {"hash", "0123456789abcdef"}, {"camera_set", "smoke"}, {"views", {0, 3}}, {"width", 24},
            {"height", 16}};
}

Json result_of(const std::vector<Json>& rows)
{
    return {{"tetrace",
             {{"schema_version", 2},
              {"verb", "bench"},
              {"date", "2026-01-31T12:00:00Z"},
              {"version", "0.1.0"},
              {"commit", "abc1234"},
              {"host", {{"cpu", "a processor"}, {"system", "a system"}}},
              {"scenes", {scene()}},
              {"rows", rows}}}};
}

/// The result with a host's pulse, whose rows ran on the host.
Json with_pulse(Json result, double seconds)
{
    Json& section = result["tetrace"];
    section["threads"] = 2;
    section["pulses"] = {{{"of", "host"}, {"fastest_s", seconds}, {"ratio", 1}, {"readings", {{0, seconds}}}}};
    for (Json& row : section["rows"])
        row["device"] = {{"name", "a processor"}, {"type", "cpu"}};
    return result;
}

class ResultComparisons : public testing::Test {
protected:
    const ResultFile& file(const char* name, const Json& json)
    {
        write_file(folder_ / name, json.dump());
        return files_.emplace_back(read_result(folder_ / name));
    }
    ResultComparison compare(const Json& before, const Json& after, const std::string& filter = {})
    {
        return compare_results(file("a.json", before), file("b.json", after), filter, 0.03);
    }
    /// What is reported of the second of two rows if its second version, or the whole second result, was changed.
    std::string difference(const std::function<void(Json& tetrace)>& change)
    {
        const Json before = result_of({timed_row("one", 1), timed_row("two", 1)});
        Json after = before;
        change(after["tetrace"]);
        std::string told;
        const std::string error = error_of([&] {
            const ComparedRow row = compare(before, after).rows[1];
            told = row.outcome == RowOutcome::different ? row.verdict() + ": " + row.note() : "";
        });
        return error + told;
    }

    TemporaryFolder folder_;
    std::deque<ResultFile> files_;
};

} // namespace

TEST_F(ResultComparisons, judges_each_row_by_its_name)
{
    const auto comparison =
        compare(result_of({timed_row("same", 1), timed_row("slower", 1), timed_row("faster", 1)}),
                result_of({timed_row("faster", 0.8), timed_row("slower", 1.25), timed_row("same", 1.001)}));
    ASSERT_EQ(comparison.rows.size(), 3u);
    for (const ComparedRow& row : comparison.rows) {
        std::string expected = row.name();
        std::transform(expected.begin(), expected.end(), expected.begin(), ::toupper);
        EXPECT_EQ(row.verdict(), expected);
        EXPECT_EQ(row.note(), "");
    }
    EXPECT_NEAR(comparison.rows[1].change->ratio, 0.8, 1e-9);
    ASSERT_EQ(comparison.regressions(false).size(), 1u);
    EXPECT_EQ(comparison.regressions(false)[0]->name(), "slower");
    EXPECT_NEAR(comparison.geometric_mean().value(), std::cbrt(0.8 * 1.25 / 1.001), 1e-9);
    EXPECT_NEAR(comparison.error(), 0.01, 1e-12);
}

TEST_F(ResultComparisons, lists_rows_that_failed_or_are_missing_and_counts_none_as_fast)
{
    const Json before = result_of({timed_row("good", 1), timed_row("broken", 1), timed_row("differs", 1),
                                   timed_row("skipped", 1), timed_row("gone", 1), untimed_row("old", "error")});
    const Json after = result_of({timed_row("good", 1), untimed_row("broken", "error"), untimed_row("differs", "wrong"),
                                  untimed_row("skipped", "skipped"), timed_row("new", 1e-6), timed_row("old", 1e-6)});
    const auto comparison = compare(before, after);
    std::map<std::string, std::string> verdicts, notes;
    for (const ComparedRow& row : comparison.rows) {
        verdicts[row.name()] = row.verdict();
        notes[row.name()] = row.note();
    }
    const std::map<std::string, std::string> expected = {
        {"good", "SAME"},    {"broken", "FAILED"}, {"differs", "FAILED"}, {"skipped", "MISSING"},
        {"gone", "MISSING"}, {"new", "NEW"},       {"old", "NEW"}};
    EXPECT_EQ(verdicts, expected);
    EXPECT_EQ(notes["broken"], "B: error: the reason");
    EXPECT_EQ(notes["gone"], "B: no such row");
    EXPECT_EQ(notes["new"], "A: no such row");
    EXPECT_NEAR(comparison.geometric_mean().value(), 1, 1e-9);
    EXPECT_EQ(comparison.regressions(false).size(), 4u);
    EXPECT_EQ(comparison.regressions(true).size(), 2u);
}

// The same row, minutes apart, six times slower, and each run is steady by itself.
TEST_F(ResultComparisons, pairs_rows_of_one_size_among_several_with_those_of_that_size_alone)
{
    const auto sized = [](Json result, const std::string& label, int width) {
        Json scene = result["tetrace"]["scenes"][0];
        scene.update({{"name", label}, {"width", width}});
        return scene;
    };
    Json many = result_of({timed_row("cdt/cubes/size:24x16/one", 1), timed_row("cdt/cubes/size:48x16/one", 1)});
    Json& section = many["tetrace"];
    section["scenes"] = {sized(many, "cubes/size:24x16", 24), sized(many, "cubes/size:48x16", 48)};
    section["rows"][0]["scene"] = "cubes/size:24x16";
    section["rows"][1]["scene"] = "cubes/size:48x16";
    const Json alone = result_of({timed_row("cdt/cubes/one", 1)});
    for (const bool is_first : {true, false}) {
        const ResultComparison compared = is_first ? compare(many, alone) : compare(alone, many);
        ASSERT_EQ(compared.rows.size(), 2u);
        EXPECT_EQ(compared.count(RowOutcome::compared), 1u);
        EXPECT_EQ(compared.count(is_first ? RowOutcome::missing : RowOutcome::added), 1u) << "of the other size";
    }
}

TEST_F(ResultComparisons, a_machine_that_was_itself_slower_makes_no_regression)
{
    const Json before = with_pulse(result_of({timed_row("one", 1)}), 0.01);
    const Json after = with_pulse(result_of({timed_row("one", 6)}), 0.06);
    const auto comparison = compare(before, after);
    EXPECT_EQ(comparison.rows[0].verdict(), "NOISY");
    EXPECT_EQ(comparison.rows[0].note(), "the same machine's calibration took 6.00 times as long in B as in A");
    EXPECT_TRUE(comparison.regressions(false).empty());
    EXPECT_EQ(compare(after, before).rows[0].note(),
              "the same machine's calibration took 6.00 times as long in A as in B");
    EXPECT_EQ(compare(before, with_pulse(result_of({timed_row("one", 6)}), 0.0124)).rows[0].verdict(), "SLOWER")
        << "a pulse that kept its time leaves the row its verdict";
}

TEST_F(ResultComparisons, pulses_of_two_machines_or_teams_say_nothing_and_a_gpus_row_does_not_need_the_hosts)
{
    const Json before = with_pulse(result_of({timed_row("one", 1)}), 0.01);
    const Json after = with_pulse(result_of({timed_row("one", 2)}), 0.02);
    const auto verdict_with = [&](const std::function<void(Json & tetrace)>& change) {
        Json changed = after;
        change(changed["tetrace"]);
        return compare(before, changed).rows[0].verdict();
    };
    EXPECT_EQ(verdict_with([](Json&) {}), "NOISY");
    EXPECT_EQ(verdict_with([](Json& section) { section["label"] = "another machine"; }), "SLOWER");
    EXPECT_EQ(verdict_with([](Json& section) { section["threads"] = 1; }), "SLOWER");
    EXPECT_EQ(verdict_with([](Json& section) { section.erase("pulses"); }), "SLOWER");
    const auto on_gpu = [](Json result) {
        result["tetrace"]["rows"][0]["device"]["type"] = "gpu";
        return result;
    };
    EXPECT_EQ(compare(on_gpu(before), on_gpu(after)).rows[0].verdict(), "SLOWER");
}

TEST_F(ResultComparisons, a_row_whose_pulse_moved_within_its_run_is_noisy)
{
    const Json quiet = result_of({timed_row("one", 1)});
    Json moved = result_of({timed_row("one", 2)});
    moved["tetrace"]["rows"][0]["times"]["pulse"] = 1.25;
    EXPECT_EQ(compare(quiet, moved).rows[0].note(), "in B calibration during its samples took 1.25 times its fastest");
    EXPECT_EQ(compare(moved, quiet).rows[0].verdict(), "NOISY");
    Json few = moved;
    few["tetrace"]["rows"][0]["times"]["samples_s"] = {2.0, 2.0, 2.0};
    EXPECT_EQ(compare(quiet, few).rows[0].verdict(), "UNSURE") << "that samples are too few is said first";
    moved["tetrace"]["rows"][0]["times"]["pulse"] = 1.24;
    EXPECT_EQ(compare(quiet, moved).rows[0].verdict(), "SLOWER");
}

TEST_F(ResultComparisons, has_no_mean_where_all_failed)
{
    const auto comparison = compare(result_of({timed_row("one", 1)}), result_of({untimed_row("one", "wrong")}));
    EXPECT_FALSE(comparison.geometric_mean());
    EXPECT_EQ(comparison.regressions(true).size(), 1u);
}

TEST_F(ResultComparisons, a_row_that_is_wrong_has_no_rate_even_where_it_has_samples)
{
    Json wrong = timed_row("one", 1e-6);
    wrong["status"] = "wrong";
    EXPECT_EQ(compare(result_of({timed_row("one", 1)}), result_of({wrong})).rows[0].verdict(), "FAILED");
}

TEST_F(ResultComparisons, rows_of_different_work_are_listed_with_the_reason_and_the_others_compared)
{
    EXPECT_EQ(difference([](Json& tetrace) { tetrace["rows"][1]["hit_hash"] = "00000000000000fe"; }),
              "DIFFERENT: hit hash 00000000000000ff in A and 00000000000000fe in B");
    EXPECT_EQ(difference([](Json& tetrace) { tetrace["rows"][1].erase("hit_hash"); }), "DIFFERENT: no hit hash in B");
    EXPECT_EQ(difference([](Json&) {}), "");
    const Json before = result_of({timed_row("one", 1), timed_row("two", 1)});
    Json after = result_of({timed_row("one", 1), timed_row("two", 100)});
    after["tetrace"]["rows"][1]["hit_hash"] = "00000000000000fe";
    const auto comparison = compare(before, after);
    EXPECT_EQ(comparison.rows[0].verdict(), "SAME");
    EXPECT_EQ(comparison.count(RowOutcome::different), 1u);
    EXPECT_NEAR(comparison.geometric_mean().value(), 1, 1e-9) << "different work is excluded";
    EXPECT_TRUE(comparison.regressions(false).empty()) << "nor is it a regression";
}

TEST_F(ResultComparisons, views_of_a_gpu_that_are_launched_together_and_singly_are_different_work)
{
    for (const char* const type : {"gpu", "cpu"}) {
        Json before = result_of({timed_row("one", 1), timed_row("two", 1)});
        before["tetrace"]["rows"][1]["device"] = {{"name", "a device"}, {"type", type}};
        Json after = before;
        after["tetrace"]["rows"][1]["times"]["launches"] = 1;
        const ComparedRow row = compare(before, after).rows[1];
        EXPECT_EQ(row.outcome == RowOutcome::different, std::string(type) == "gpu");
        if (row.outcome == RowOutcome::different) {
            EXPECT_EQ(row.note(), "a launch for each view in A, all views in 1 launch in B");
        }
        EXPECT_EQ(compare(after, after).rows[1].verdict(), "SAME");
        after["tetrace"]["rows"][1]["times"]["launches"] = after["tetrace"]["scenes"][0]["views"].size();
        EXPECT_EQ(compare(before, after).rows[1].verdict(), "SAME") << "each view has a launch in both";
    }
}

TEST_F(ResultComparisons, is_refused_where_all_rows_did_different_work)
{
    const std::string hash = difference([](Json& tetrace) { tetrace["scenes"][0]["hash"] = "0000000000000000"; });
    EXPECT_TRUE(contains(hash, "invalid_input: "));
    EXPECT_TRUE(contains(hash, "2 rows, such as one: the scene cubes has hash 0123456789abcdef in A and "
                               "0000000000000000 in B"));
    EXPECT_TRUE(contains(difference([](Json& tetrace) { tetrace["scenes"][0]["width"] = 25; }),
                         "2 views of smoke at 24x16 in A, 2 views of smoke at 25x16 in B"));
    EXPECT_TRUE(contains(difference([](Json& tetrace) { tetrace["scenes"][0]["views"] = {0, 2}; }), "other views"));
    EXPECT_TRUE(contains(difference([](Json& tetrace) { tetrace["scenes"].clear(); }), "not among tetrace.scenes"));
}

// A BVH does not know which tets are around its triangles.
TEST_F(ResultComparisons, rows_of_bvhs_compare_by_their_mesh_and_those_of_tets_by_the_scene)
{
    Json before = result_of({timed_row("bvh/bvh2/cubes", 1), timed_row("cdt/maria/cubes", 1)});
    before["tetrace"]["scenes"][0]["source_hash"] = "00000000000000aa";
    Json after = before;
    after["tetrace"]["scenes"][0]["hash"] = "0000000000000000";
    const auto verdicts = [&](const Json& a, const Json& b) {
        const auto rows = compare(a, b).rows;
        return rows[0].verdict() + ", " + rows[1].verdict();
    };
    EXPECT_EQ(verdicts(before, after), "SAME, DIFFERENT") << "older results have only the mesh file's hash";
    after["tetrace"]["scenes"][0]["mesh_hash"] = "00000000000000bb";
    EXPECT_EQ(verdicts(before, after), "SAME, DIFFERENT");
    before["tetrace"]["scenes"][0]["mesh_hash"] = "00000000000000bb";
    EXPECT_EQ(verdicts(before, after), "SAME, DIFFERENT");
    before["tetrace"]["scenes"][0]["mesh_hash"] = "00000000000000bc";
    const std::string error = error_of([&] { (void)verdicts(before, after); });
    EXPECT_TRUE(contains(error, "the mesh of cubes has hash 00000000000000bc in A and 00000000000000bb in B")) << error;
}

TEST_F(ResultComparisons, a_refusal_names_the_options_that_bring_back_the_first_ones_work)
{
    const auto note_with = [&](const std::function<void(Json & a, Json & b)>& change) {
        Json before = result_of({timed_row("one", 1)});
        before["tetrace"]["scenes"][0]["source_hash"] = "00000000000000aa";
        before["tetrace"]["scenes"][0]["tets_kind"] = "rays";
        Json after = before;
        change(before["tetrace"]["scenes"][0], after["tetrace"]["scenes"][0]);
        return error_of([&] { (void)compare(before, after); });
    };
    const std::string rays = note_with([](Json& a, Json& b) {
        a["views"] = {0, 1, 2, 5};
        b["camera_set"] = "frame";
        b["width"] = 512;
    });
    EXPECT_TRUE(contains(rays, "measure B with --camera-set smoke --views 0-2,5 --size 24x16")) << rays;
    const std::string pinned = note_with([](Json& a, Json&) { a["hash"] = "02e9d84d743616a3"; });
    EXPECT_TRUE(contains(pinned, "measure B with --scene bunny-1")) << pinned;
    const std::string kind = note_with([](Json& a, Json& b) {
        a["tets_kind"] = "cdt";
        b["hash"] = "0000000000000000";
    });
    EXPECT_TRUE(contains(kind, "measure B with --tets cdt")) << kind;
    const std::string version = note_with([](Json&, Json& b) { b["hash"] = "0000000000000000"; });
    EXPECT_TRUE(contains(version, "made other tets of cubes with the same options")) << version;
    const std::string mesh = note_with([](Json&, Json& b) { b["source_hash"] = b["hash"] = "0000000000000000"; });
    EXPECT_TRUE(contains(mesh, "A's cubes was made from another mesh file, of hash 00000000000000aa")) << mesh;
}

TEST_F(ResultComparisons, a_refusal_of_results_without_a_common_row_says_how_a_was_measured)
{
    Json before = result_of({timed_row("one", 1)}), after = result_of({timed_row("two", 1)});
    before["tetrace"]["rows"][0]["rays"] = "shadow";
    after["tetrace"]["rows"][0]["rays"] = "primary";
    before["tetrace"]["rows"][0]["layout"] = after["tetrace"]["rows"][0]["layout"] = "bvh2";
    const std::string options = error_of([&] { (void)compare(before, after); });
    EXPECT_TRUE(options.ends_with("; measure B with --rays shadow")) << options;
    before["tetrace"]["rows"].push_back(untimed_row("two", "skipped"));
    EXPECT_EQ(error_of([&] { (void)compare(before, after); }), options) << "A lacks a rate of the row that they share";
    Json packed = before;
    packed["tetrace"]["scenes"][0]["hash"] = "02e9d84d743616a3"; // bunny-1
    EXPECT_TRUE(contains(error_of([&] { (void)compare(packed, after); }), "measure B with --scene bunny-1 --rays"));
    before["tetrace"]["command"] = "tetrace bench --rays shadow,ao";
    const std::string command = error_of([&] { (void)compare(before, after); });
    EXPECT_TRUE(command.ends_with("; A was measured by `tetrace bench --rays shadow,ao`")) << command;
}

TEST_F(ResultComparisons, of_a_scene_with_two_names_pair_its_rows)
{
    const Json before = result_of({timed_row("cdt/maria/cubes/primary", 1)});
    Json after = result_of({timed_row("cdt/maria/packed/primary", 1)});
    after["tetrace"]["scenes"][0]["name"] = after["tetrace"]["rows"][0]["scene"] = "packed";
    EXPECT_EQ(compare(before, after).rows.at(0).verdict(), "SAME");
    after["tetrace"]["scenes"][0]["hash"] = "0000000000000000";
    EXPECT_TRUE(contains(error_of([&] { (void)compare(before, after); }), "they share no row"));
}

TEST_F(ResultComparisons, pair_no_row_twice_and_first_those_of_the_same_name)
{
    Json two = result_of({timed_row("cdt/maria/packed/primary", 1), timed_row("cdt/maria/cubes/primary", 1)});
    Json& section = two["tetrace"];
    section["scenes"].push_back(section["scenes"][0]);
    section["scenes"][1]["name"] = section["rows"][0]["scene"] = "packed";
    const Json one = result_of({timed_row("cdt/maria/cubes/primary", 1)});
    const ResultComparison fewer = compare(two, one), more = compare(one, two);
    EXPECT_EQ(fewer.count(RowOutcome::compared), 1u);
    EXPECT_EQ(fewer.rows.at(0).verdict(), "MISSING") << "the row of the other name";
    EXPECT_EQ(fewer.rows.at(1).verdict(), "SAME");
    EXPECT_EQ(more.count(RowOutcome::compared), 1u);
    EXPECT_EQ(more.count(RowOutcome::added), 1u);
}

TEST_F(ResultComparisons, of_nothing_is_refused)
{
    const auto refused = [&](const Json& before, const Json& after, const std::string& filter = {}) {
        return error_of([&] { static_cast<void>(compare(before, after, filter)); });
    };
    const Json timed = result_of({timed_row("one", 1)});
    Json check = result_of({timed_row("one", 1)});
    check["tetrace"]["verb"] = "check";
    check["tetrace"]["rows"][0].erase("times");
    EXPECT_TRUE(contains(refused(check, timed), "(of 'tetrace check')"));
    EXPECT_TRUE(contains(refused(check, timed), "A lacks rows with samples"));
    EXPECT_TRUE(contains(refused(result_of({}), result_of({})), "neither has a row"));
    EXPECT_TRUE(contains(refused(timed, result_of({timed_row("two", 1)})), "share no row"));
    EXPECT_TRUE(contains(refused(timed, result_of({})), "share no row"));
    EXPECT_TRUE(contains(refused(timed, timed, "nothing"), "--filter 'nothing' matches no row"));
    // A check after a bench: nothing is as fast as before.
    EXPECT_EQ(compare(timed, check).rows[0].verdict(), "MISSING");
    EXPECT_EQ(compare(timed, check).rows[0].note(), "B: no samples");
}

namespace {

/// A row of Table 5, as searches_json() makes it.
Json search_row(const char* name, double seconds)
{
    return {{"name", name},
            {"backend", "openmp"},
            {"status", "ok"},
            {"face_hash", "00000000000000ff"},
            {"msearches_per_s", 8 / seconds},
            {"times", {{"samples_s", samples_around(seconds)}}}};
}

Json searches_of(const std::vector<Json>& rows)
{
    Json result = result_of({});
    result["tetrace"]["verb"] = "reproduce";
    result["tetrace"]["searches"] = {{"tets", 1000}, {"rays_a_tet", 8000}, {"rows", rows}};
    return result;
}

} // namespace

TEST_F(ResultComparisons, judges_exit_searches_like_rows)
{
    const auto comparison = compare(searches_of({search_row("search/a", 1), search_row("search/b", 1)}),
                                    searches_of({search_row("search/a", 1.25), search_row("search/b", 1.001)}));
    ASSERT_EQ(comparison.rows.size(), 2u);
    EXPECT_EQ(comparison.rows[0].verdict(), "SLOWER");
    EXPECT_EQ(comparison.rows[1].verdict(), "SAME");
    EXPECT_DOUBLE_EQ(comparison.rows[0].after->mrays_per_s.value(), 6.4);
}

TEST_F(ResultComparisons, searches_of_other_numbers_or_with_other_faces_did_different_work)
{
    const Json before = searches_of({search_row("search/a", 1), search_row("search/b", 1)});
    Json faces = before;
    faces["tetrace"]["searches"]["rows"][1]["face_hash"] = "0000000000000011";
    const auto comparison = compare(before, faces);
    EXPECT_EQ(comparison.rows[0].verdict(), "SAME");
    EXPECT_EQ(comparison.rows[1].verdict(), "DIFFERENT");
    Json fewer = before;
    fewer["tetrace"]["searches"]["tets"] = 500;
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(compare(before, fewer)); }),
                         "1000 x 8000 searches in A, 500 x 8000 in B"));
}

TEST_F(ResultComparisons, rows_of_scenes_and_searches_of_one_result_are_compared_together)
{
    Json result = searches_of({search_row("search/a", 1)});
    result["tetrace"]["rows"] = {timed_row("one", 1)};
    const auto comparison = compare(result, result);
    ASSERT_EQ(comparison.rows.size(), 2u);
    EXPECT_EQ(comparison.rows[0].name(), "one");
    EXPECT_EQ(comparison.rows[1].name(), "search/a");
    EXPECT_EQ(comparison.count(RowOutcome::compared), 2u);
}

/// The row under another API.
Json under(const char* api, Json row)
{
    row["backend"] = api;
    const std::string name = row["name"];
    row["name"] = name.substr(0, name.find("/api:")) + "/api:" + api;
    return row;
}

TEST_F(ResultComparisons, of_two_apis_are_of_answers_alone)
{
    const Json row = timed_row("cdt/a/api:openmp", 1), slower = under("webgpu", timed_row("cdt/a/api:openmp", 5));
    const ResultComparison same = compare(result_of({row}), result_of({slower}));
    ASSERT_EQ(same.rows.size(), 1u);
    EXPECT_EQ(same.rows.front().verdict(), "SAME ANSWERS");
    EXPECT_EQ(same.rows.front().note(), "openmp in A and webgpu in B, whose rates are not compared");
    EXPECT_FALSE(same.rows.front().change);
    EXPECT_TRUE(same.regressions(false).empty());
    EXPECT_FALSE(same.geometric_mean());

    Json other = slower;
    other["hit_hash"] = "00000000000000fe";
    EXPECT_TRUE(contains(error_of([&] { (void)compare(result_of({row}), result_of({other})); }),
                         "hit hash 00000000000000ff in A and 00000000000000fe in B"));
    EXPECT_TRUE(compare(result_of({row, under("opencl", row)}), result_of({slower})).regressions(false).empty());
    // A row of an API that both have is not another API's.
    const ResultComparison shared =
        compare(result_of({row, under("opencl", row)}), result_of({slower, under("opencl", row)}));
    ASSERT_EQ(shared.rows.size(), 3u);
    EXPECT_EQ(shared.rows[0].verdict(), "MISSING");
    EXPECT_EQ(shared.rows[1].verdict(), "SAME");
    EXPECT_EQ(shared.rows[2].verdict(), "NEW");
}
