#include "bench/terminal/text.h"
#include "tests/support/program_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sys/wait.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

class Program : public ProgramTest {};

} // namespace

TEST_F(Program, describes_itself)
{
    EXPECT_TRUE(contains(run("").out, "Usage: tetrace VERB"));
    for (const char* part : {"tetrace ", "; kernels exact: ", "Embree ", ", fmt ", "Apache License"})
        EXPECT_TRUE(contains(run("--version").out, part)) << part;
    for (const char* const verb : {"devices", "scenes", "build", "bench", "check", "render", "reproduce", "inspect",
                                   "compare", "show", "report", "help"}) {
        const Ended help = run(std::string(verb) + (std::string(verb) == "help" ? "" : " --help"));
        EXPECT_EQ(help.code, 0);
        EXPECT_TRUE(contains(help.out, "Example")) << verb;
        EXPECT_EQ(help.errors, "");
    }
    EXPECT_TRUE(contains(run("help options").out, "| `--scene SCENE` |"));
}

TEST_F(Program, bench_and_reproduce_fail_without_what_they_require_and_junit_says_so)
{
    const ScopedVariable none("CUDA_VISIBLE_DEVICES", "");
    const Ended measured = bench("--layout tet80 --require openmp --junit b.xml");
    EXPECT_EQ(measured.code, 0) << measured.errors;
    EXPECT_TRUE(contains(file("b.xml"), "<testsuites name=\"tetrace bench\" tests=\"1\" failures=\"0\" errors=\"0\">"));
    EXPECT_TRUE(bench("--layout tet80 --junit -").out.starts_with("<?xml"));
    const Ended missing = run("bench --scene cubes --size 8 --require cuda --junit c.xml");
    EXPECT_EQ(missing.code, 3) << missing.errors;
    EXPECT_TRUE(contains(missing.errors, "--require cuda: no usable device here: ")) << missing.errors;
    EXPECT_TRUE(contains(file("c.xml"), "classname=\"tetrace.bench\" name=\"has a result\""));
    const Ended reproduced = run("reproduce table3 --scene cubes --size 8 --require cuda");
    EXPECT_EQ(reproduced.code, 3) << reproduced.errors;
    EXPECT_TRUE(contains(reproduced.errors, "--require cuda: ")) << reproduced.errors;
}

TEST_F(Program, reproduce_takes_other_cameras_and_render_the_row_that_a_filter_keeps)
{
    const Ended table = run("reproduce table4 --scene cubes --resolution 3 --size 8 --backend openmp --method maria "
                            "--layout tet80 --camera-set smoke --out t.json");
    EXPECT_EQ(table.code, 0) << table.errors;
    const auto scene = nlohmann::json::parse(file("t.json"))["tetrace"]["scenes"][0];
    EXPECT_EQ(scene["camera_set"], "smoke");
    EXPECT_EQ(scene["views"].size(), 4u);
    const std::string picture = "render --scene cubes --resolution 3 --size 8 --views 0 --out a.ppm --filter ";
    EXPECT_EQ(run(picture + "bvh2.*openmp").code, 0);
    EXPECT_EQ(run(picture + "bvh3").code, 2);
}

TEST_F(Program, report_writes_a_page_from_results)
{
    have_measured("a.json");
    const Ended report = run("report a.json a.json --out page.html");
    EXPECT_EQ(report.code, 0) << report.errors;
    EXPECT_TRUE(contains(report.errors, "page.html"));
    EXPECT_TRUE(contains(file("page.html"), "cdt maria tet80"));
    EXPECT_TRUE(contains(file("page.html"), "2 results"));
    EXPECT_EQ(run("report a.json").code, 0);
    EXPECT_FALSE(file("report.html").empty()) << "the default name";
}

TEST_F(Program, report_writes_charts_and_efficiencies_as_files_and_lists_them)
{
    have_measured("a.json");
    const Ended report = run("report a.json --charts figures --portability e.csv --out page.html");
    EXPECT_EQ(report.code, 0) << report.errors;
    std::size_t charts = 0;
    for (const auto& chart : std::filesystem::directory_iterator(folder_ / "figures")) {
        EXPECT_TRUE(contains(report.errors, "figures/" + chart.path().filename().string() + "\n")) << report.errors;
        ++charts;
    }
    EXPECT_GT(charts, 0u);
    EXPECT_TRUE(file("e.csv").starts_with("problem,platform,application,efficiency,noisy,mrays_per_s\n"));
    EXPECT_TRUE(contains(report.errors, "e.csv: ")) << report.errors;
    const Ended refused = run("report a.json --portability a.json");
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(contains(refused.errors, "--portability: writing 'a.json' would replace the input")) << refused.errors;
    const Ended no_folder = run("report a.json --charts a.json/figures");
    EXPECT_EQ(no_folder.code, 2);
    EXPECT_TRUE(contains(no_folder.errors, "--charts: cannot create the folder 'a.json/figures': "))
        << no_folder.errors;
}

TEST_F(Program, report_of_a_folder_is_the_page_of_a_campaign)
{
    std::filesystem::create_directories(folder_ / "results/host");
    have_measured("results/a.json");
    auto other = nlohmann::json::parse(file("results/a.json"));
    other["tetrace"]["label"] = "two";
    write_file(folder_ / "results/host/b.json", other.dump());
    write_file(folder_ / "results/notes.json", "{}");
    write_file(folder_ / "results/notes.txt", "no JSON");
    const Ended ended = run("report results --out page.html");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "1 of these 3 left out")) << ended.errors;
    const std::string page = file("page.html");
    for (const char* const part :
         {"id=\"index\"", "host/b.json", "results/a.json", "notes.json", "id=\"compared-machines\""})
        EXPECT_TRUE(contains(page, part)) << part;
    EXPECT_EQ(run("report results --out results/a.json").code, 2) << "it would replace an input";
    std::filesystem::create_directory(folder_ / "empty");
    const Ended empty = run("report empty");
    EXPECT_EQ(empty.code, 2);
    EXPECT_TRUE(contains(empty.errors, "it has no .json file")) << empty.errors;
}

TEST_F(Program, report_names_what_it_cannot_use)
{
    const Ended nothing = run("report");
    EXPECT_EQ(nothing.code, 2);
    EXPECT_TRUE(contains(nothing.errors, "no file is given"));
    EXPECT_EQ(run("report none.json").code, 3);
    EXPECT_EQ(run("report stdout").code, 2) << "no JSON";
    EXPECT_TRUE(contains(run("help report").out, "Usage: tetrace report RESULT|FOLDER... [OPTION]..."));
}

TEST_F(Program, usage_errors_go_to_standard_error_with_exit_code_2)
{
    for (const char* const bad :
         {"draw", "bench --sizes 3", "bench --size 0", "bench --scene nothing-of-that-name", "check --filter '('",
          "bench --scene cubes --filter nothing", "bench --benchmark_bogus=1", "bench --benchmark_format=xml",
          "bench --scene cubes --out result.xyz", "bench --scene cubes,cubes",
          "bench --scene cubes --benchmark_filter=nothing"}) {
        const Ended ended = run(bad);
        EXPECT_EQ(ended.code, 2) << bad << ended.errors;
        EXPECT_EQ(ended.out, "") << bad;
        EXPECT_NE(ended.errors, "") << bad;
    }
    EXPECT_TRUE(contains(run("bench --backend openmp,embree --scene cubes --filter nothing").errors,
                         "matches none of the 19 rows"));
}

TEST_F(Program, renders_without_openimageio)
{
    const Ended ended = run("render --backend openmp --scene cubes --resolution 3 --views 0 --size 16 --out a.ppm");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(ended.out, "a.ppm\n");
    const std::string header = "P6\n16 16\n255\n", picture = file("a.ppm");
    ASSERT_EQ(picture.size(), header.size() + 3 * 16 * 16);
    EXPECT_TRUE(contains(picture, header));
    EXPECT_NE(picture.find_first_not_of(picture.back(), header.size()), std::string::npos) << "of one colour";
}

TEST_F(Program, lists_devices_with_their_backends)
{
    const Ended ended = run("devices --require openmp,embree --format json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto section = nlohmann::json::parse(ended.out)["tetrace"];
    EXPECT_EQ(section["devices"][0]["backend"], "openmp");
    EXPECT_EQ(section["devices"][0]["status"], "usable");
    EXPECT_EQ(section["parts"].size(), 2u);
    EXPECT_TRUE(contains(run("devices").out, "openmp"));
}

TEST_F(Program, lists_scenes_and_clears_the_cache)
{
    const Ended table = run("scenes");
    EXPECT_EQ(table.code, 0) << table.errors;
    for (const char* const name : {"cubes", "banana", "bunny", "armadillo"})
        EXPECT_TRUE(contains(table.out, name));
    const Ended cleared = run("scenes --clear --format json");
    ASSERT_EQ(cleared.code, 0) << cleared.errors;
    EXPECT_EQ(nlohmann::json::parse(cleared.out)["tetrace"]["cache"]["files"].size(), 0u);
}

TEST_F(Program, benches_and_writes_the_table_and_the_json)
{
    const Ended ended = bench(std::string("--views 0-3 --out result.json") + nine_rows);
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "Mrays/s"));
    EXPECT_TRUE(contains(ended.out, "Verified  20,736 rays"));
    const auto json = nlohmann::json::parse(file("result.json"));
    EXPECT_EQ(json["tetrace"]["schema_version"], 2);
    ASSERT_EQ(json["tetrace"]["rows"].size(), 9u);
    for (const auto& row : json["tetrace"]["rows"]) {
        EXPECT_EQ(row["status"], "ok") << row;
        EXPECT_EQ(row["times"]["samples_s"].size(), 3u);
        EXPECT_GT(row["rates"]["mrays_per_s"].get<double>(), 0);
        EXPECT_EQ(row["verification"]["rays"], 4 * 24 * 24);
        EXPECT_EQ(row["hit_hash"].get<std::string>().size(), 16u);
    }
    EXPECT_EQ(json["tetrace"]["rows"][0]["hit_hash"], json["tetrace"]["rows"][1]["hit_hash"]) << "tet80 and tet96";
    EXPECT_EQ(json["tetrace"]["scenes"][0]["views"].size(), 4u);
    EXPECT_EQ(json["tetrace"]["scenes"][0]["hash"].get<std::string>().size(), 16u);
}

TEST_F(Program, the_same_rays_give_the_same_hashes_whatever_the_number_of_threads)
{
    const auto hash = [&](const std::string& more) {
        return nlohmann::json::parse(
            bench("--layout tet80 --format json " + more).out)["tetrace"]["rows"][0]["hit_hash"];
    };
    const auto first = hash("--threads 1");
    EXPECT_EQ(first, hash("--threads 3"));
    EXPECT_NE(first, hash("--views 0"));
}

TEST_F(Program, benches_as_csv_and_markdown)
{
    const Ended csv = bench(std::string("--format csv") + nine_rows);
    ASSERT_EQ(csv.code, 0) << csv.errors;
    EXPECT_EQ(csv.out.rfind("name,scene,structure,method,", 0), 0u);
    EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 10);
    EXPECT_TRUE(contains(bench("--format markdown").out, "\n| row | backend | Mrays/s |"));
    const Ended to_file = bench("--format csv --out table.csv");
    EXPECT_EQ(to_file.out, "");
    EXPECT_EQ(file("table.csv").rfind("name,scene", 0), 0u);
}

TEST_F(Program, lists_rows_without_loading_scenes)
{
    const Ended ours = run("bench --backend openmp,embree --scene bunny,armadillo --list");
    EXPECT_EQ(ours.code, 0) << ours.errors;
    EXPECT_EQ(std::count(ours.out.begin(), ours.out.end(), '\n'), 38);
    EXPECT_EQ(run("bench --backend openmp,embree --scene bunny,armadillo --benchmark_list_tests").out, ours.out);
    EXPECT_EQ(
        run("bench --backend openmp,embree --scene bunny --benchmark_list_tests=true --benchmark_filter=-bvh").out,
        "cdt/maria/tet80/bunny/primary/math:exact/api:openmp\ncdt/maria/tet96/bunny/primary/math:exact/api:openmp\n"
        "cdt/project/half32/bunny/primary/math:exact/api:openmp\n"
        "cdt/project/tet64/bunny/primary/math:exact/api:openmp\n"
        "cdt/project/half32/bunny/primary/math:exact/schedule:packets/api:openmp\n");
}

TEST_F(Program, google_benchmarks_flags_keep_their_meaning)
{
    const Ended ended = bench("--benchmark_filter='tet80.*openmp$' --benchmark_repetitions=5 --benchmark_out=gb.json "
                              "--out ours.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto ours = nlohmann::json::parse(file("ours.json"));
    ASSERT_EQ(ours["tetrace"]["rows"].size(), 1u);
    EXPECT_EQ(ours["tetrace"]["rows"][0]["times"]["samples_s"].size(), 5u);
    const auto theirs = nlohmann::json::parse(file("gb.json"));
    EXPECT_EQ(theirs["benchmarks"][0]["name"], "cdt/maria/tet80/cubes/primary/math:exact/api:openmp");
    EXPECT_GE(theirs["benchmarks"].size(), 5u);
    EXPECT_EQ(bench("--benchmark_report_aggregates_only=true --format csv").code, 0);
    EXPECT_EQ(bench("--benchmark_format=csv").out.rfind("name,iterations,", 0), 0u);
}

TEST_F(Program, checks_every_ray)
{
    const Ended ended = run(
        "check --backend openmp,embree --scene cubes --resolution 6 --size 24 --math exact,fast --order chains,input "
        "--require openmp,embree --out check.json" +
        std::string(nine_rows));
    ASSERT_EQ(ended.code, 0) << ended.out << ended.errors;
    const auto rows = nlohmann::json::parse(file("check.json"))["tetrace"]["rows"];
    EXPECT_EQ(rows.size(), 25u);
    for (const auto& row : rows) {
        EXPECT_EQ(row["status"], "ok") << row;
        const auto& found = row["verification"];
        EXPECT_EQ(found["rays"].get<int>(), found["agreed"].get<int>() + found["ties"].get<int>() +
                                                found["settled"].get<int>() + found["offset"].get<int>() +
                                                found["wrong"].get<int>() + found["lost"].get<int>());
    }
}

TEST_F(Program, check_shows_rows_against_devices_and_writes_junit)
{
    const Ended ended = run("check --backend openmp --scene cubes --resolution 6 --size 24 --junit check.xml "
                            "--out check.json");
    ASSERT_EQ(ended.code, 0) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.out, "cdt maria tet96             reference"));
    EXPECT_TRUE(contains(ended.out, "self-test, exact mode"));
    const auto section = nlohmann::json::parse(file("check.json"))["tetrace"];
    const auto& cell = section["matrix"]["cubes"]["cdt maria tet80"]["openmp"];
    EXPECT_EQ(cell["cell"], "reference");
    EXPECT_EQ(cell["hit_hash"], section["rows"][0]["hit_hash"]);
    EXPECT_EQ(section["rows"][0]["self_test"]["exact"], true);
    EXPECT_TRUE(contains(file("check.xml"), "tests=\"8\" failures=\"0\" errors=\"0\" skipped=\"0\""));
    EXPECT_TRUE(contains(file("check.xml"), "classname=\"tetrace.openmp."));
    EXPECT_TRUE(contains(file("check.xml"), "<property name=\"tetrace.version\""));
}

TEST_F(Program, a_run_of_which_no_row_could_run_does_not_pass)
{
    const ScopedVariable none("CUDA_VISIBLE_DEVICES", ""); // where there is a GPU, CUDA has none for this program
    const auto expect_missing = [&](const char* verb, const char* text) {
        const Ended ended =
            run(std::string(verb) + " --backend cuda --scene cubes --resolution 6 --size 24 --out a.json");
        EXPECT_EQ(ended.code, 3) << ended.out;
        EXPECT_TRUE(contains(ended.errors, text)) << ended.errors;
        const auto row = nlohmann::json::parse(file("a.json"))["tetrace"]["rows"][0];
        EXPECT_TRUE(contains(ended.errors, row["reason"].get<std::string>())) << ended.errors;
    };
    expect_missing("check", "nothing was checked");
    expect_missing("bench", "nothing was measured");
    expect_missing("reproduce table3 --views 0", "nothing was measured");
}

TEST_F(Program, a_check_that_ends_early_says_why_in_its_junit_and_on_standard_error)
{
    const ScopedVariable none("CUDA_VISIBLE_DEVICES", "");
    const std::string tiny = " --scene cubes --resolution 3 --size 8 --junit check.xml";
    for (const char* const arguments :
         {"check --require cuda", "check --require embree --backend openmp", "check --backend openmp --device nvidia",
          "check --backend openmp --scene no-such-scene", "check --backend cuda"}) {
        std::filesystem::remove(folder_ / "check.xml");
        const Ended ended = run(arguments + tiny);
        EXPECT_NE(ended.code, 0) << arguments;
        const std::string reason = ended.errors.substr(0, ended.errors.find('\n'));
        ASSERT_TRUE(reason.starts_with("tetrace: ")) << arguments << ended.errors;
        EXPECT_TRUE(contains(file("check.xml"), "<error message=\"" + xml_text(reason.substr(9)))) << file("check.xml");
        EXPECT_TRUE(contains(file("check.xml"), "errors=\"1\"")) << file("check.xml");
    }
}

TEST_F(Program, a_device_that_is_missing_is_reported_in_one_line)
{
    for (const char* const verb : {"check", "bench", "render"}) {
        const Ended ended = run(std::string(verb) + " --scene cubes --backend openmp,embree --device nvidia");
        EXPECT_EQ(ended.code, 3) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "no device's name contains nvidia")) << ended.errors;
        EXPECT_TRUE(contains(ended.errors, "(openmp, embree)")) << ended.errors;
        EXPECT_EQ(std::count(ended.errors.begin(), ended.errors.end(), '\n'), 1) << ended.errors;
    }
}

TEST_F(Program, checks_embree_where_it_is_asked_for)
{
    const auto rows_of = [&](const std::string& options) { return run("check --scene cubes --list" + options).out; };
    EXPECT_FALSE(contains(rows_of(""), "api:embree"));
    EXPECT_TRUE(contains(rows_of(" --structure cdt,bvh"), "api:embree"));
    EXPECT_TRUE(contains(rows_of(" --require embree"), "api:embree"));
}

TEST_F(Program, builds_every_combination_and_goes_on_after_a_failure)
{
    std::ofstream(folder_.path() / "broken.tet") << "no scene";
    const Ended ended = run("build --scene cubes,broken.tet --resolution 6 --size 24 --format json");
    EXPECT_EQ(ended.code, 2) << ended.errors;
    const auto builds = nlohmann::json::parse(ended.out)["tetrace"]["builds"];
    ASSERT_EQ(builds.size(), 2u);
    EXPECT_EQ(builds[0]["status"], "ok");
    EXPECT_EQ(builds[0]["tets"], 6 * 6 * 6 * 6);
    EXPECT_GT(builds[0]["mean_steps_hit"].get<double>(), 1);
    EXPECT_EQ(builds[1]["status"], "error");
    EXPECT_TRUE(contains(builds[1]["reason"].get<std::string>(), "broken.tet")) << builds[1];
}

TEST_F(Program, a_scene_that_cannot_be_loaded_ends_its_rows_and_not_the_others)
{
    std::ofstream(folder_.path() / "broken.tet") << "no scene";
    const Ended ended = run("bench --backend openmp,embree --scene cubes,broken.tet --resolution 6 --size 24 --samples "
                            "3 --sample-time 0 --format json" +
                            std::string(nine_rows));
    EXPECT_NE(ended.code, 0);
    const auto rows = nlohmann::json::parse(ended.out)["tetrace"]["rows"];
    ASSERT_EQ(rows.size(), 18u);
    for (const auto& row : rows) {
        EXPECT_EQ(row["status"], row["scene"] == "cubes" ? "ok" : "error") << row;
        EXPECT_EQ(row.contains("rates"), row["scene"] == "cubes");
    }
}

TEST_F(Program, a_result_that_cannot_be_written_is_reported_before_any_work)
{
    const Ended ended = bench("--out no/such/folder/result.json");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "no/such/folder/result.json")) << ended.errors;
}

TEST_F(Program, google_benchmarks_result_that_cannot_be_written_is_reported_before_any_work)
{
    const Ended ended = bench("--benchmark_out=no/such/folder/gb.json");
    EXPECT_EQ(ended.code, 2);
    EXPECT_EQ(ended.out, "");
    EXPECT_TRUE(contains(ended.errors, "no/such/folder/gb.json")) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "--benchmark_out"));
}

TEST_F(Program, a_result_leaves_out_what_does_not_apply_and_where_files_lie)
{
    const Ended ended = bench("--layout tet80 --out result.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const auto section = nlohmann::json::parse(file("result.json"))["tetrace"];
    const auto& times = section["rows"][0]["times"];
    EXPECT_FALSE(times.contains("compile_s"));
    EXPECT_FALSE(times.contains("upload_s"));
    EXPECT_TRUE(times.contains("pack_s"));
    EXPECT_GE(times["overhead_s"].get<double>(), 0);
    const auto& verification = section["rows"][0]["verification"];
    EXPECT_EQ(verification.contains("largest_tie_distance"), verification["ties"] > 0);
    EXPECT_FALSE(contains(section["scenes"][0].value("file", ""), "/"));
    EXPECT_TRUE(contains(section["flags"].get<std::string>(), "exact: -ffp-contract=off"));
    EXPECT_TRUE(contains(section["flags"].get<std::string>(), "fast: -ffp-contract=fast -ffast-math"));
}

TEST_F(Program, google_benchmarks_context_is_added_once)
{
    const Ended ended = bench("--layout tet80 --benchmark_context=a=b --benchmark_format=json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_EQ(nlohmann::json::parse(ended.out)["context"]["a"], "b");
    EXPECT_FALSE(contains(ended.errors, "ontext")) << ended.errors;
}

TEST_F(Program, a_result_has_the_processors_family_model_and_stepping)
{
    const std::string processor = read_text("/proc/cpuinfo");
    if (!contains(processor, "cpu family")) GTEST_SKIP() << "this system does not report them of its processor";
    const auto host = nlohmann::json::parse(run("devices --format json").out)["tetrace"]["host"];
    EXPECT_TRUE(contains(processor, fmt::format("cpu family\t: {}\n", host["family"].get<unsigned>())));
    EXPECT_TRUE(contains(processor, fmt::format("model\t\t: {}\n", host["model"].get<unsigned>())));
    EXPECT_TRUE(contains(processor, fmt::format("stepping\t: {}\n", host["stepping"].get<unsigned>())));
}

TEST_F(Program, a_result_has_the_threads_that_worked)
{
    const auto threads = [&](const std::string& more) {
        return nlohmann::json::parse(bench("--layout tet80 --format json " + more).out)["tetrace"]["threads"];
    };
    EXPECT_EQ(threads("--threads 1"), 1);
    EXPECT_EQ(threads("--threads 3"), 3);
    const ScopedVariable variable("OMP_NUM_THREADS", "1");
    EXPECT_EQ(threads(""), 1);
    EXPECT_EQ(threads("--threads 2"), 2);
}

TEST_F(Program, a_required_backend_without_a_selected_row_is_no_success)
{
    const std::string check = "check --scene cubes --resolution 6 --size 24 ";
    const Ended ended = run(check + "--require embree --backend openmp");
    EXPECT_EQ(ended.code, 3);
    EXPECT_TRUE(contains(ended.errors, "no row of embree is selected")) << ended.errors;
    EXPECT_EQ(run(check + "--require openmp --backend openmp").code, 0);
}

TEST_F(Program, no_progress_line_without_a_terminal)
{
    const Ended ended = bench("");
    EXPECT_FALSE(contains(ended.errors, "\r")) << ended.errors;
}
