// What the sections of the page show of results, and what they say where there is nothing to show.
#include "bench/report/sections.h"
#include "tests/output/report_fixture.h"

#include <set>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::vector<std::string> drawings_of(const std::string& page)
{
    std::vector<std::string> drawings;
    for (std::size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1))
        drawings.push_back(page.substr(at, page.find("</svg>", at) - at));
    return drawings;
}

/// Cells of a matrix that lead to a row.
std::size_t rows_linked(const std::string& section)
{
    std::size_t count = 0;
    for (std::size_t at = section.find("<a href=\"#row-"); at != std::string::npos;
         at = section.find("<a href=\"#row-", at + 1))
        ++count;
    return count;
}

} // namespace

TEST_F(ReportPage, every_row_has_its_mark_or_its_reason)
{
    const std::string page = page_of({bench_json()});
    using Rows = std::multiset<std::string>;
    EXPECT_EQ(rows_of(section_of(page, "rates"), "mark "), (Rows{"row/openmp", "row/cuda", "row/vulkan"}));
    EXPECT_EQ(rows_of(section_of(page, "rates"), "unrated"), (Rows{"row/opencl"}));
    EXPECT_EQ(rows_of(section_of(page, "roofline"), "mark "), (Rows{"row/openmp", "row/cuda", "row/vulkan"}));
    EXPECT_EQ(rows_of(section_of(page, "ratios"), "mark "), (Rows{"row/vulkan"}));
    EXPECT_TRUE(contains(section_of(page, "rates"), "a reason"));
}

/// bench_json() with a BVH on the GPU, of another rate.
json with_bvh(double mrays_per_s)
{
    json result = bench_json();
    json row = row_json("row/bvh", "cuda", "gpu", innocent);
    row.update({{"structure", "bvh"}, {"method", "single"}, {"layout", "bvh2"}});
    row["rates"]["mrays_per_s"] = mrays_per_s;
    result["tetrace"]["rows"].push_back(row);
    return result;
}

TEST_F(ReportPage, begins_with_the_papers_claim_on_this_machine)
{
    const auto answer_of = [&](const json& result) { return section_of(page_of({result}), "answer"); };
    const std::string faster = answer_of(with_bvh(2));
    EXPECT_TRUE(contains(faster,
                         "cubes on a device of cuda: rays go through the tets 2.00 times as fast as through the "
                         "fastest BVH, bvh bvh2 on cuda"))
        << faster;
    using Rows = std::multiset<std::string>;
    EXPECT_EQ(rows_of(faster, "mark "), (Rows{"row/cuda", "row/bvh"}));
    EXPECT_TRUE(contains(answer_of(with_bvh(8)),
                         "through the tets 2.00 times as slowly as through the fastest BVH, bvh bvh2 on cuda"));
    const std::string page = page_of({with_bvh(2)});
    EXPECT_LT(page.find("id=\"answer\""), page.find("<nav>")) << "before everything else";
    EXPECT_TRUE(contains(answer_of(bench_json()), "no section")) << "without a BVH to compare with";
}

TEST_F(ReportPage, names_the_fastest_bvh_with_every_ratio_of_tets_to_it)
{
    json result = with_bvh(2);
    json& rows = result["tetrace"]["rows"];
    json rt = rows.back();
    rt.update({{"name", "row/rt"}, {"layout", "rt"}, {"math", "fast"}, {"backend", "vulkan"}});
    rt["rates"]["mrays_per_s"] = 3.0;
    rows.push_back(rt);
    EXPECT_TRUE(contains(section_of(page_of({result}), "answer"),
                         "1.33 times as fast as through the fastest BVH, bvh rt on vulkan"))
        << "of another API on the same GPU";
    EXPECT_FALSE(contains(section_of(page_of({result}), "ratios"), "fastest BVH"))
        << "an older result lacks such a ratio";
    rows[1]["rates"].update({{"best_bvh", "row/rt"}, {"ratio_to_best_bvh", 1.333}});
    EXPECT_TRUE(contains(section_of(page_of({result}), "ratios"), "1.33<")) << "without an interval";
    rows[1]["rates"].update({{"ratio_to_best_bvh_low", 1.25}, {"ratio_to_best_bvh_high", 1.5}});
    const std::string ratios = section_of(page_of({result}), "ratios");
    EXPECT_TRUE(contains(ratios, "1.33 [1.25, 1.50]")) << ratios;
    EXPECT_TRUE(contains(ratios, "bvh rt vulkan")) << ratios;
    rows[1]["rates"]["best_bvh"] = "row/none";
    EXPECT_TRUE(contains(error_of_page(result), "but no row has that name"));
}

TEST_F(ReportPage, shows_a_kernel_that_this_version_lacks_but_ranks_nothing_with_it)
{
    json result = with_bvh(2);
    json row = result["tetrace"]["rows"].back();
    row.update({{"name", "row/later"}, {"layout", "bvh99"}});
    result["tetrace"]["rows"].push_back(row);
    const std::string page = page_of({result});
    EXPECT_TRUE(contains(section_of(page, "rates"), "bvh bvh99"));
    EXPECT_TRUE(contains(section_of(page, "answer"), "no section"));
}

TEST_F(ReportPage, says_how_many_rays_enter_and_hit)
{
    json result = bench_json();
    EXPECT_FALSE(contains(section_of(page_of({result}), "rates"), "of these rays"));
    json& counts = result["tetrace"]["rows"][1]["counts"];
    counts.update({{"rays", 1000}, {"hits", 160}});
    EXPECT_TRUE(contains(section_of(page_of({result}), "rates"), "16 % of these rays hit."));
    counts["entering"] = 450;
    EXPECT_TRUE(contains(section_of(page_of({result}), "rates"), "45 % of these rays enter the domain, and 16 % hit."));
    counts["entering"] = 1001;
    EXPECT_TRUE(contains(error_of_page(result), "counts.entering: exceeds the number of rays"));
}

TEST_F(ReportPage, every_device_and_scene_has_its_answer_and_emulated_ones_have_none)
{
    json result = with_bvh(2);
    json host = result["tetrace"]["rows"].back(), emulated = host;
    host.update({{"name", "row/host bvh"}, {"backend", "openmp"}});
    host["device"] = {{"name", "the host"}, {"type", "cpu"}};
    emulated.update({{"name", "row/emulated bvh"}, {"backend", "vulkan"}});
    emulated["device"] = {{"name", "llvmpipe"}, {"type", "emulated"}};
    json walk = host;
    walk.update({{"name", "row/host cdt"}, {"structure", "cdt"}, {"method", "project"}, {"layout", "half32"}});
    for (const json& row : {host, emulated, walk})
        result["tetrace"]["rows"].push_back(row);
    const std::string answer = section_of(page_of({result}), "answer");
    EXPECT_LT(answer.find("on a device of cuda"), answer.find("on the host")) << "GPUs come first";
    EXPECT_FALSE(contains(answer, "llvmpipe"));
}

TEST_F(ReportPage, links_to_no_section_that_has_nothing)
{
    const auto links_to = [&](const std::string& page, const char* id) {
        return contains(page, std::string("<a href=\"#") + id + "\"");
    };
    const std::string measured = page_of({bench_json()}), checked = page_of({check_json()});
    for (const char* const id : {"rates", "ratios", "roofline", "times"}) {
        EXPECT_TRUE(links_to(measured, id)) << id;
        EXPECT_FALSE(links_to(checked, id)) << id;
    }
    for (const char* const id : {"conformance", "compilers", "paper", "pictures"})
        EXPECT_FALSE(links_to(measured, id)) << id;
    EXPECT_TRUE(links_to(checked, "conformance"));
}

TEST_F(ReportPage, what_is_wrong_leads_to_its_row_and_the_reason)
{
    json checked = check_json();
    json row = row_json("row/vulkan", "vulkan", "emulated", innocent);
    row.update({{"status", "wrong"}, {"reason", "12 rays differ from openmp's"}});
    row.erase("rates");
    checked["tetrace"]["rows"] = {row};
    const std::string page = page_of({checked}), section = section_of(page, "conformance");
    const std::string link = "<a href=\"#row-0-0\">";
    EXPECT_TRUE(contains(section, link + "<span class=\"badge")) << section;
    EXPECT_TRUE(contains(section, "id=\"row-0-0\""));
    EXPECT_TRUE(contains(section, "12 rays differ"));
    EXPECT_TRUE(contains(section_of(page, "answer"), "0 of 1 rows of check are right. " + link + "1 is wrong"));
}

/// The same rows of task segments, and all at two sizes.
json with_segments_at_two_sizes()
{
    json result = bench_json();
    json& section = result["tetrace"];
    const json scene = section["scenes"][0], rows = section["rows"];
    section["scenes"] = section["rows"] = section["ratios"] = json::array();
    for (const int width : {24, 48}) {
        const std::string size = fmt::format("cubes/size:{}x16", width);
        section["scenes"].push_back(scene);
        section["scenes"].back().update({{"name", size}, {"width", width}});
        for (const char* const task : {"trace", "segments"})
            for (json row : rows) {
                row["name"] = fmt::format("{}/{}/{}", task, size, row["name"].get<std::string>());
                row["scene"] = size;
                if (task == std::string("segments")) row["task"] = task;
                if (task == std::string("segments") && row.contains("rates")) row["rates"]["mrays_per_s"] = 1.0;
                section["rows"].push_back(row);
            }
    }
    for (const char* const task : {"trace", "segments"})
        section["ratios"].push_back({{"row", fmt::format("{}/cubes/size:24x16/row/cuda", task)},
                                     {"reference", fmt::format("{}/cubes/size:24x16/row/openmp", task)},
                                     {"ratio", 1.1},
                                     {"low", 0.9},
                                     {"high", 1.2}});
    return result;
}

TEST_F(ReportPage, segments_are_apart_from_what_is_traced)
{
    const std::string page = page_of({with_segments_at_two_sizes()});
    const std::string sizes = section_of(page, "sizes");
    for (const char* const row : {"cdt maria tet80  openmp", "segments maria tet80  openmp"})
        EXPECT_TRUE(contains(sizes, row)) << row << sizes;
    EXPECT_TRUE(contains(section_of(page, "times"), "segments maria tet80"));
    EXPECT_EQ(drawings_of(section_of(page, "ratios")).size(), 2u) << "a chart of each task";
    EXPECT_TRUE(contains(section_of(page, "ratios"), "segments of primary rays"));
    EXPECT_TRUE(contains(section_of(page, "ratios"), "segments maria tet80"));
}

TEST_F(ReportPage, what_is_wrong_with_segments_leads_to_their_row)
{
    json checked = check_json();
    json row = row_json("row/vulkan", "vulkan", "emulated", innocent);
    row.update({{"status", "wrong"}, {"reason", "12 rays"}, {"task", "segments"}, {"rays", "random"}});
    row.erase("rates");
    checked["tetrace"]["rows"] = {row};
    auto& cells = checked["tetrace"]["matrix"]["cubes"];
    cells["segments maria tet80, random"] = cells["cdt maria tet80"];
    EXPECT_EQ(rows_linked(section_of(page_of({checked}), "conformance")), 1u) << "not that of the same walk";
}

TEST_F(ReportPage, what_a_check_was_expected_to_show_is_a_table_and_none_without_expectations)
{
    json checked = check_json();
    EXPECT_FALSE(contains(page_of({checked}), "Expectations"));
    json& expectations = checked["tetrace"]["expectations"];
    expectations = {{"files", {"drivers.json"}}, {"deviations", json::array()}, {"unmentioned", json::array()}};
    EXPECT_TRUE(contains(section_of(page_of({checked}), "conformance"),
                         "Judged by the expectations of drivers.json. All is as expected."));
    expectations["deviations"].push_back({{"name", "row/vulkan"},
                                          {"device", "vulkan"},
                                          {"judgement", "unexpected pass"},
                                          {"expected", "wrong"},
                                          {"shown", "bit-exact"}});
    expectations["unmentioned"].push_back("openmp");
    const std::string section = section_of(page_of({checked}), "conformance");
    EXPECT_TRUE(contains(section, "<td>row/vulkan</td><td>vulkan</td><td>wrong</td><td>bit-exact</td>")) << section;
    EXPECT_TRUE(contains(section, "unexpected pass"));
    EXPECT_TRUE(contains(section, "None mentions openmp, which is expected to conform."));
}

TEST_F(ReportPage, wide_tables_scroll_by_themselves_and_say_so)
{
    const std::string page = page_of({bench_json(), check_json()});
    EXPECT_TRUE(contains(section_of(page, "machines"), "<div class=\"scroll wide\" tabindex=\"0\"><table>"));
    EXPECT_TRUE(contains(section_of(page, "conformance"), "<div class=\"scroll\" tabindex=\"0\"><table>"))
        << "three columns fit a phone";
    const std::string phones = page.substr(page.find("@media (max-width"));
    EXPECT_TRUE(contains(phones, ".wide::before { content: \"wider than the screen: scroll")) << phones.substr(0, 300);
}

TEST_F(ReportPage, emulated_devices_and_gpus_share_no_chart)
{
    const std::string rates = section_of(page_of({bench_json(), bench_json()}), "rates");
    const auto drawings = drawings_of(rates);
    EXPECT_EQ(drawings.size(), 3u);
    for (const std::string& drawing : drawings) {
        const auto rows = rows_of(drawing, "mark ");
        EXPECT_EQ(rows.size(), 2u) << "the same rays of both results are in one chart";
        EXPECT_EQ(std::set<std::string>(rows.begin(), rows.end()).size(), 1u);
    }
}

TEST_F(ReportPage, processors_of_one_name_are_distinguished)
{
    json zen3 = bench_json(), zen5 = bench_json();
    for (json* result : {&zen3, &zen5})
        for (json* device : {&(*result)["tetrace"]["devices"][0], &(*result)["tetrace"]["rows"][0]["device"]})
            (*device)["name"] = (*result)["tetrace"]["host"]["cpu"];
    zen3["tetrace"]["host"].update({{"family", 25}, {"model", 1}, {"stepping", 1}});
    zen5["tetrace"]["label"] = "Zen 5";
    const std::string page = page_of({zen3, zen5});
    for (const char* const section : {"machines", "rates", "roofline"}) {
        EXPECT_TRUE(contains(section_of(page, section), "(family 25, model 1, stepping 1)")) << section;
        EXPECT_TRUE(contains(section_of(page, section), "Zen 5")) << section;
    }
}

TEST_F(ReportPage, a_result_reports_what_other_work_the_machine_had)
{
    json busy = bench_json();
    busy["tetrace"]["load"] = {{"others", 1.25}, {"average", 3.5}, {"processors", 2}};
    busy["tetrace"]["pulses"] = {{{"of", "host"}, {"fastest_s", 0.01}, {"ratio", 6.0}, {"readings", {{0, 0.01}}}}};
    const std::string told = section_of(page_of({busy}), "machines");
    EXPECT_TRUE(contains(told, ">1.25</td>"));
    EXPECT_TRUE(contains(told, ">6.00</td>"));
    const std::string silent = section_of(page_of({bench_json()}), "machines");
    for (const char* const title : {">others ", ">calibration "})
        EXPECT_FALSE(contains(silent, title)) << title;
}

TEST_F(ReportPage, what_compilers_report_is_a_table_of_programs)
{
    json inspected = {{"tetrace", head_json("inspect", innocent)}};
    inspected["tetrace"]["skipped_targets"] = {"sm_90: no nvcc"};
    inspected["tetrace"]["programs"] = {{{"target", "gfx1100"},
                                         {"structure", "cdt"},
                                         {"method", "project"},
                                         {"layout", "half32"},
                                         {"math", "exact"},
                                         {"schedule", "tiles"},
                                         {"entry", "outside"},
                                         {"status", "ok"},
                                         {"compiler", "radv <22>"},
                                         {"registers", 60},
                                         {"subgroups", 24},
                                         {"most_subgroups", 32},
                                         {"latency_cycles", 41234.4},
                                         {"cycles_a_subgroup", 6348.0},
                                         {"fused", 0},
                                         {"fused_in", "nothing"}},
                                        {{"target", "gfx1100"},
                                         {"structure", "bvh"},
                                         {"method", "single"},
                                         {"layout", "bvh2"},
                                         {"math", "exact"},
                                         {"schedule", "tiles"},
                                         {"entry", "outside"},
                                         {"status", "ok"},
                                         {"compiler", "radv <22>"},
                                         {"fused", 12},
                                         {"fused_in", "boxes"},
                                         {"first_fused", "v_fma_f32 v1, <v2>"}},
                                        {{"target", "sm_90"},
                                         {"structure", "cdt"},
                                         {"method", "maria"},
                                         {"layout", "tet80"},
                                         {"math", "exact"},
                                         {"schedule", "tiles"},
                                         {"entry", "outside"},
                                         {"status", "skipped"},
                                         {"reason", "no nvcc"}}};
    const std::string section = section_of(page_of({inspected}), "compilers");
    for (const char* const shown :
         {"gfx1100", "project half32", "radv &lt;22&gt;", ">75<", "none", ">41,234<", ">6,348<",
          "12 in boxes<small>v_fma_f32 v1, &lt;v2&gt;</small>", "<li>skipped: sm_90: no nvcc</li>"})
        EXPECT_TRUE(contains(section, shown)) << shown;
    EXPECT_FALSE(contains(section, "maria tet80")) << "a target that was skipped has a sentence, and no row a program";
    json nothing = inspected;
    nothing["tetrace"]["programs"] = json::array({inspected["tetrace"]["programs"][2]});
    EXPECT_TRUE(contains(section_of(page_of({nothing}), "compilers"), "no compiler"));
}

TEST_F(ReportPage, other_rays_have_a_chart_of_their_own)
{
    json other = bench_json();
    other["tetrace"]["scenes"][0]["hash"] = "fedcba9876543210";
    const std::string rates = section_of(page_of({bench_json(), other}), "rates");
    EXPECT_EQ(drawings_of(rates).size(), 6u);
}

TEST(ReportColours, are_those_of_earlier_pages_and_one_for_each_backend)
{
    const std::vector<std::string> first = {"openmp", "embree", "opencl", "vulkan", "cuda", "cuda-host"};
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(api_series(first[i]), i) << first[i];
    std::set<std::size_t> seen;
    for (const Backend* backend : all_backends())
        EXPECT_TRUE(seen.insert(api_series(backend->name())).second) << backend->name();
}

TEST_F(ReportPage, a_row_of_an_unmeasured_device_is_on_no_roofline)
{
    json result = bench_json();
    for (json& device : result["tetrace"]["devices"])
        device.erase("copy_bytes_per_s");
    EXPECT_TRUE(contains(section_of(page_of({result}), "roofline"), "no section"));
}

TEST_F(ReportPage, the_papers_values_are_next_to_ours_with_the_verdicts)
{
    const std::string paper = section_of(page_of({reproduce_json()}), "paper");
    EXPECT_TRUE(contains(paper, "12.5<small>12.0 to 13.0</small><small class=\"paper\">paper 25.0, × 0.500</small>"));
    EXPECT_TRUE(contains(paper, "✓</span> holds"));
    EXPECT_TRUE(contains(paper, "✗</span> does not hold"));
    EXPECT_TRUE(contains(paper, "class=\"line\""));
    EXPECT_TRUE(contains(page_of({reproduce_json()}), "2 claims of the paper: 1 hold, 1 do not hold"));
}

TEST_F(ReportPage, numbers_have_the_decimals_of_their_column)
{
    json result = reproduce_json();
    json& table = result["tetrace"]["tables"][0];
    table["columns"][1]["decimals"] = 0;
    table["rows"][0]["rate"] = {{"value", 9}, {"paper", 1282}, {"ratio", 9.0 / 1282}};
    const std::string paper = section_of(page_of({result}), "paper");
    EXPECT_TRUE(contains(paper, ">9<small class=\"paper\">paper 1,282, × 0.00702</small>")) << paper;
    table["columns"][1]["decimals"] = 16;
    EXPECT_TRUE(contains(error_of_page(result), "columns[1].decimals: is not a number of decimals"));
}

TEST_F(ReportPage, what_is_not_in_the_results_is_left_out)
{
    json empty = bench_json();
    for (const char* const key : {"devices", "rows", "ratios", "scenes"})
        empty["tetrace"].erase(key);
    const std::string page = page_of({empty});
    for (const char* const absent : {"<svg", "class=\"trust", "Devices", "Scenes"})
        EXPECT_FALSE(contains(page, absent)) << absent;
    for (const char* const id :
         {"compared", "rates", "ratios", "roofline", "conformance", "compilers", "paper", "pictures", "times"})
        EXPECT_EQ(section_of(page, id), std::string("no section ") + id);
    EXPECT_TRUE(contains(section_of(page, "machines"), "<table>"));
}

TEST_F(ReportPage, values_that_cannot_be_drawn_are_named_with_their_key)
{
    const auto error_with = [&](json result, const char* pointer, const json& value) {
        result[json::json_pointer(std::string("/tetrace") + pointer)] = value;
        return error_of_page(result);
    };
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/0/rates/mrays_per_s", 0), "rows[0].rates.mrays_per_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/0/rates/mrays_per_s", nullptr), "rows[0].rates.mrays_per_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/1/times/median_s", "1"), "rows[1].times.median_s"));
    EXPECT_TRUE(
        contains(error_with(bench_json(), "/rows/1/task", "search"), "rows[1].task: is not a task that rows name"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/devices/0/type", "fpga"), "devices[0].type: is 'fpga'"));
    json nowhere = bench_json();
    nowhere["tetrace"]["rows"][1].erase("device");
    EXPECT_TRUE(contains(error_of_page(nowhere), "rows[1]: has a rate and no device"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/devices/0/copy_bytes_per_s", -1), "devices[0].copy_bytes_per_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/ratios/0/low", 0), "ratios[0].low"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/ratios/0/row", "none"), "no row has that name"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/0/scene", "none"), "not among its scenes"));
    EXPECT_TRUE(
        contains(error_with(reproduce_json(), "/figures/0/series/0/points/1", {1}), "points[1]: is not a point"));
    EXPECT_TRUE(contains(error_with(reproduce_json(), "/figures/0/series/0/points/1/0", 1e300), "points[1][0]"));
    EXPECT_TRUE(contains(error_with(reproduce_json(), "/figures/0/x/scale", "cubic"), "is not a scale"));
    json logarithmic = reproduce_json();
    logarithmic["tetrace"]["figures"][0]["x"]["scale"] = "logarithmic";
    EXPECT_TRUE(contains(error_with(logarithmic, "/figures/0/series/0/points/1/0", 0), "on a logarithmic axis"));
    EXPECT_TRUE(contains(error_with(reproduce_json(), "/tables/0/rows/0/rate", false), "rows[0].rate"));
}
