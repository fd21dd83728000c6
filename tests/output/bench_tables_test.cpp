
#include "bench/measuring/budget.h"
#include "bench/output/bench_report.h"
#include "bench/output/row_fields.h"
#include "bench/terminal/text.h"
#include "tests/support/fake_backend.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <regex>
#include <set>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The host under five APIs, as on a machine with every emulation, and a GPU under two; two layouts each.
class BenchTables : public testing::Test {
protected:
    BenchTables()
    {
        for (const Layout layout : {Layout::tet80, Layout::tet96})
            for (FakeBackend* backend : {&vulkan_, &opencl_, &cuda_host_, &openmp_, &cuda_, &vulkan_gpu_})
                add_row(*backend, layout);
        result_.devices = devices_of(result_.rows);
        for (RowDevice& device : result_.devices)
            device.yardstick = Yardstick{123.4e9, 123.4e-6};
        compare();
    }

    void compare()
    {
        result_.comparisons = compare_rows(result_.rows);
        result_.best_bvhs = compare_with_best_bvh(result_.rows);
    }

    void add_row(FakeBackend& backend, Layout layout)
    {
        RowRecord row;
        row.key = {"bunny", backend.name(), {}, RayKind::primary, TetOrder::chains, &backend == &vulkan_gpu_ ? 1u : 0u};
        row.key.kernel.layout = layout;
        row.clock = "a clock";
        row.device = backend.devices()[0];
        Traced result;
        result.totals.rays = 4'000'000'000;
        result.totals.hit_steps = 40'000'000'000;
        row.outcome = result;
        row.samples_s = {9, 10, 11, 10, 9, 11};
        row.wall_samples_s = {10, 11, 12, 11, 10, 12};
        result_.rows.push_back(std::move(row));
    }

    static Device device(const char* name, DeviceKind kind, const char* implementation, const char* uuid = "")
    {
        Device result;
        result.name = name;
        result.kind = kind;
        result.implementation = implementation;
        result.uuid = uuid;
        return result;
    }

    /// Of CSV.
    Cell flat_cell(std::size_t row, std::string_view key) const
    {
        const nlohmann::json head = nlohmann::json::parse(head_.dump()); // as a file has its numbers
        const Table table = flat_table(result_, RunOrigin(ResultValue(head, "a result")));
        for (std::size_t c = 0; c < table.columns().size(); ++c)
            if (table.columns()[c].key == key) return table.rows().at(row).at(c);
        throw std::out_of_range("no column " + std::string(key));
    }

    nlohmann::json head_ = nlohmann::json::parse(R"({ "schema_version": 2, "verb": "bench", "version": "0.1.0",
        "date": "2026-01-31T12:00:00Z", "commit": "abc1234", "label": "mine",
        "host": { "cpu": "a CPU", "family": 25, "system": "a system" },
        "scenes": [{ "name": "bunny", "hash": "0123456789abcdef", "camera_set": "frame", "views": [0, 1, 2, 3],
                     "width": 640, "height": 480 }] })");
    FakeBackend vulkan_{"vulkan", device("llvmpipe", DeviceKind::emulated, "lavapipe-22.3")};
    FakeBackend opencl_{"opencl", device("pthread", DeviceKind::emulated, "pocl-3.1")};
    FakeBackend cuda_host_{"cuda-host", device("host C++", DeviceKind::emulated, "cuda-host")};
    FakeBackend openmp_{"openmp", device("CPU", DeviceKind::cpu, "openmp")};
    FakeBackend cuda_{"cuda", device("H200", DeviceKind::gpu, "cuda-13.0", "a")};
    FakeBackend vulkan_gpu_{"vulkan", device("H200", DeviceKind::gpu, "nvidia-570", "a")};
    BenchResult result_;
};

std::size_t widest(const std::string& text)
{
    std::size_t width = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        width = std::max(width, display_width(line));
    return width;
}

} // namespace

TEST_F(BenchTables, a_run_ends_with_its_answer_and_whether_to_trust_it)
{
    RowRecord bvh;
    bvh.key = result_.rows[3].key; // openmp's
    bvh.key.kernel.structure = Structure::bvh;
    bvh.key.kernel.layout = Layout::bvh2;
    bvh.device = openmp_.devices()[0];
    bvh.outcome = result_.rows[3].outcome;
    bvh.samples_s = {5, 5, 5, 5, 5};
    result_.rows.push_back(std::move(bvh));
    compare();
    result_.measurement.wall_s = 1;
    result_.measurement.load = MachineLoad{0.05, 2.1, 2};
    const auto unwrapped = [&] { return std::regex_replace(answer_of(result_).text(), std::regex("\\s+"), " "); };
    const std::string quiet = unwrapped();
    EXPECT_TRUE(contains(quiet, "bunny (CPU): bvh bvh2 on openmp, 800.0 Mrays/s")) << quiet;
    EXPECT_TRUE(contains(quiet, "bunny (H200): ")) << quiet;
    EXPECT_TRUE(contains(
        quiet, "the fastest walk through tets, cdt maria tet80 on openmp (noisy), has 0.50 [0.45, 0.56] of the "
               "rate of the fastest BVH, bvh bvh2 on openmp"))
        << quiet;
    EXPECT_TRUE(
        contains(quiet, "APIs by openmp's rate, medians over the kernels: cuda-host 1.00, opencl 1.00, vulkan 1.00"))
        << quiet;
    EXPECT_TRUE(contains(quiet, "other processes used 0.05 of 2 CPUs while measuring")) << quiet;
    EXPECT_FALSE(contains(quiet, "do not trust")) << quiet;
    result_.measurement.load->others = 1.3;
    EXPECT_TRUE(contains(unwrapped(), "do not trust these rates")) << unwrapped();
}

TEST_F(BenchTables, a_scene_says_how_many_of_its_rays_enter_the_domain_and_hit)
{
    result_.scenes.push_back(nlohmann::json::parse(R"({ "name": "bunny", "tets": 1, "occlusive_faces": 1,
        "free_faces": 1, "divisions": 8, "domain": "tight", "build_s": 1, "from_cache": false, "views": [0, 1],
        "camera_set": "smoke", "width": 8, "height": 8 })"));
    for (RowRecord& row : result_.rows) {
        Traced& traced = std::get<Traced>(row.outcome);
        traced.totals.hits = traced.totals.rays / 8;
        traced.entering = traced.totals.rays / 4 * 3;
    }
    result_.rows[1].key.rays = RayKind::ao;
    const std::string text = bench_sheet(result_).text();
    EXPECT_TRUE(contains(text, "\nrays: 75 % enter the domain, 12 % hit\nao rays: 75 % enter the domain, 12 % hit\n"))
        << text;
    for (RowRecord& row : result_.rows)
        std::get<Traced>(row.outcome).entering.reset();
    EXPECT_TRUE(contains(bench_sheet(result_).text(), "\nrays: 12 % hit\n")) << "of an older result";
}

TEST_F(BenchTables, walks_of_one_ray_are_compared_with_bvhs_of_one_ray_as_well)
{
    const auto add = [&](const KernelId& kernel, double seconds) {
        RowRecord row;
        row.key = result_.rows[3].key; // openmp's
        row.key.kernel = kernel;
        row.device = openmp_.devices()[0];
        row.outcome = result_.rows[3].outcome;
        row.samples_s = std::vector<double>(5, seconds);
        result_.rows.push_back(std::move(row));
    };
    add({.method = Method::project, .layout = Layout::half32, .schedule = Schedule::packets}, 2);
    add({Structure::bvh, Method::single, Layout::bvh2}, 20);
    add({Structure::bvh, Method::single, Layout::cwbvh}, 40);
    add({Structure::bvh, Method::single, Layout::embree}, 8);
    add({Structure::bvh, Method::packet16, Layout::embree}, 4);
    compare();
    const std::string text = std::regex_replace(answer_of(result_).text(), std::regex("\\s+"), " ");
    EXPECT_TRUE(contains(text,
                         "the fastest walk through tets, cdt project half32 packets on openmp, has 2.00 [2.00, 2.00] "
                         "of the rate of the fastest BVH, bvh packet16 on openmp; one ray at a time, cdt maria tet80 "
                         "on openmp (noisy) has 2.00 [1.82, 2.22] of the rate of bvh bvh2 on openmp and 0.80 [0.73, "
                         "0.89] of the rate of bvh single on openmp"))
        << text;
    const std::string table = rate_table("bunny", result_).text(2, 160);
    EXPECT_TRUE(contains(table, "x best BVH")) << table;
    EXPECT_TRUE(contains(table, "0.40 [")) << "maria over packet16\n" << table;
    const nlohmann::json row = row_json(facts_of(result_).at(3));
    EXPECT_EQ(row.at("rates").at("best_bvh"), row_name(result_.rows.back().key));
    EXPECT_DOUBLE_EQ(row.at("rates").at("ratio_to_best_bvh"), 0.4);
    EXPECT_FALSE(row.contains("break_even")) << "no build time is known";
}

TEST_F(BenchTables, the_fastest_bvh_is_that_of_all_bvh_rows_of_the_hardware)
{
    const std::vector<double> samples = {8, 5, 2, 4};
    const KernelId kernels[] = {
        {.structure = Structure::bvh, .method = Method::single, .layout = Layout::bvh2},
        {Structure::bvh, Method::packet16, Layout::embree, MathMode::fast},
        {Structure::bvh, Method::stream, Layout::embree_robust, MathMode::fast},
        {Structure::bvh, Method::packet8, Layout::embree_medium, MathMode::fast},
    };
    for (std::size_t i = 0; i < samples.size(); ++i) {
        RowRecord bvh;
        bvh.key = result_.rows[3].key; // openmp's
        bvh.key.kernel = kernels[i];
        bvh.device = openmp_.devices()[0];
        bvh.outcome = result_.rows[3].outcome;
        bvh.samples_s = std::vector<double>(5, samples[i]);
        result_.rows.push_back(std::move(bvh));
    }
    compare();
    const std::string text = std::regex_replace(answer_of(result_).text(), std::regex("\\s+"), " ");
    EXPECT_TRUE(contains(text, "has 0.20 [0.18, 0.22] of the rate of the fastest BVH, bvh stream robust on openmp"))
        << text;
}

TEST_F(BenchTables, rows_stand_by_device_under_what_they_may_be_ranked_with)
{
    const std::string text = rate_table("bunny", result_).text();
    const auto cpu = text.find("CPU (cpu)"), openmp = text.find("openmp  "), emulated = text.find("emulated on"),
               opencl = text.find("opencl  "), gpu = text.find("H200 (gpu)"), cuda = text.find("cuda   ");
    for (const auto place : {cpu, openmp, emulated, opencl, gpu, cuda})
        ASSERT_NE(place, std::string::npos) << text;
    EXPECT_TRUE(cpu < openmp && openmp < emulated && emulated < opencl && opencl < gpu && gpu < cuda) << text;
}

TEST_F(BenchTables, fit_a_page_of_110_columns)
{
    const std::string rates = rate_table("bunny", result_).text(2, 110);
    EXPECT_LE(widest(rates), 110u) << rates;
    EXPECT_LE(widest(time_table(result_).text(2)), 110u);
    EXPECT_LE(widest(device_table(result_.devices).text(2)), 110u);
}

TEST_F(BenchTables, comparisons_show_their_interval_and_references_none)
{
    const Table table = rate_table("bunny", result_);
    const auto column = std::ranges::find(table.columns(), "comparison", &Column::key);
    ASSERT_NE(column, table.columns().end());
    const auto place = static_cast<std::size_t>(column - table.columns().begin());
    int with = 0;
    for (const auto& row : table.rows()) {
        const auto* text = std::get_if<std::string>(&row[place]);
        if (text == nullptr) continue;
        ++with;
        EXPECT_EQ(text->substr(0, 7), " 1.00 [") << *text;
    }
    EXPECT_EQ(with, 2 * 4) << "three emulations after openmp, and Vulkan's GPU after cuda, in two layouts";
    EXPECT_EQ(column->title, "x reference") << "openmp and cuda both are";
}

TEST_F(BenchTables, a_row_that_did_not_run_comes_last)
{
    result_.rows[0].outcome = Failed{ErrorKind::internal, "no scene"};
    result_.rows[0].device = {};
    const std::string text = rate_table("bunny", result_).text();
    EXPECT_GT(text.find("not run"), text.find("H200 (gpu)")) << text;
}

TEST_F(BenchTables, rows_that_did_not_run_are_one_line_below_the_table)
{
    const std::size_t all = rate_table("bunny", result_).rows().size();
    for (const std::size_t row : {0, 1, 2})
        result_.rows[row].outcome =
            Skipped{Status::skipped, fmt::format("would take about {} s{}7m it is measured", row + 1, with_budget)};
    result_.rows[3].outcome = Skipped{Status::unsupported, "no such buffers"};
    EXPECT_EQ(rate_table("bunny", result_).rows().size(), all - 4);
    EXPECT_EQ(flat_cell(2, "status"), Cell(std::string("skipped"))) << "CSV has all";
    const std::string text = failure_lines(result_.rows).text();
    EXPECT_EQ(text, "4 rows did not run: 3 skipped (--budget 7m is enough), " + row_name(result_.rows[3].key) +
                        " unsupported (no such buffers).\n\n");
    result_.rows[3].outcome = Failed{ErrorKind::driver, "device lost"};
    EXPECT_EQ(failure_lines(result_.rows).text(),
              row_name(result_.rows[3].key) + ": error: device lost\n" + "3 rows, such as " +
                  row_name(result_.rows[0].key) +
                  ": skipped: would take about 1 s; with --budget 7m it is measured\n\n");
}

TEST_F(BenchTables, no_two_columns_of_csv_have_one_key)
{
    for (const Place place : {&RowField::csv, &RowField::check}) {
        std::set<std::string> keys;
        for (const Column& column : columns_of(place))
            EXPECT_TRUE(keys.insert(column.key).second) << column.key;
    }
}

TEST_F(BenchTables, no_two_fields_have_one_place_in_json)
{
    std::set<std::pair<std::string, std::string>> places;
    for (const RowField& field : row_fields()) {
        if (field.schema == nullptr) continue;
        EXPECT_TRUE(places.insert({field.group, field.key}).second) << field.key;
    }
}

TEST_F(BenchTables, what_the_page_of_report_shows_is_in_json)
{
    for (const RowField& field : row_fields())
        EXPECT_TRUE(field.report.title == nullptr || field.schema != nullptr) << field.key;
}

TEST_F(BenchTables, a_row_has_its_schedule_in_csv_and_json)
{
    result_.rows[0].key.kernel.schedule = Schedule::packets;
    EXPECT_TRUE(row_json(RowFacts(result_.rows[0]))["schedule"] == "packets");
    EXPECT_TRUE(flat_cell(0, "schedule") == Cell("packets"));
    EXPECT_TRUE(flat_cell(1, "schedule") == Cell("tiles"));
}

TEST_F(BenchTables, a_row_has_in_csv_what_made_it)
{
    result_.rows[0].device.driver = "lavapipe 22.3";
    result_.rows[1].key.scene = "not loaded";
    const std::pair<const char*, const char*> cells[] = {
        {"label", "mine"},     {"processor", "a CPU (family 25)"},
        {"commit", "abc1234"}, {"date", "2026-01-31T12:00:00Z"},
        {"size", "640x480"},   {"camera_set", "frame"},
        {"views", "0-3"},      {"driver", "lavapipe 22.3"},
    };
    for (const auto& [key, text] : cells)
        EXPECT_TRUE(flat_cell(0, key) == Cell(text)) << key;
    EXPECT_TRUE(is_empty(flat_cell(1, "views")));
    EXPECT_TRUE(flat_cell(1, "label") == Cell("mine"));
    for (const auto& [views, text] : std::vector<std::pair<std::vector<int>, const char*>>{
             {{5}, "5"}, {{0, 20, 40}, "0-40:20"}, {{0, 5, 6}, "0,5-6"}, {{1, 2, 3, 9, 12}, "1-3,9,12"}}) {
        head_["scenes"][0]["views"] = views;
        EXPECT_TRUE(flat_cell(0, "views") == Cell(text)) << text;
    }
}

TEST_F(BenchTables, a_row_whose_tree_is_a_fall_back_says_so_in_json_and_in_its_status)
{
    EXPECT_FALSE(row_json(RowFacts(result_.rows[0])).contains("fall_back")) << "of the best tree";
    EXPECT_FALSE(contains(rate_table("bunny", result_).text(), "fall-back tree"));
    result_.rows[0].fall_back = "it is too deep";
    EXPECT_EQ(row_json(RowFacts(result_.rows[0])).at("fall_back"), "it is too deep");
    EXPECT_TRUE(contains(rate_table("bunny", result_).text(), "fall-back tree"));
}

TEST_F(BenchTables, a_row_of_embrees_packets_names_the_narrower_ones_that_they_are_split_into)
{
    RowRecord& row = result_.rows[0];
    const auto packets = [&](Method method, unsigned native_width) {
        row.key.kernel = {
            .structure = Structure::bvh, .method = method, .layout = Layout::embree_robust, .math = MathMode::fast};
        row.device.group_width = native_width;
        const nlohmann::json object = row_json(RowFacts(row));
        const unsigned narrower = object.value("narrower_packets", 0u);
        EXPECT_EQ(contains(rate_table("bunny", result_).text(), "in packets of"), narrower != 0);
        return narrower;
    };
    EXPECT_EQ(packets(Method::packet16, 8), 8u);
    EXPECT_TRUE(contains(rate_table("bunny", result_).text(), "noisy, in packets of 8"));
    EXPECT_EQ(packets(Method::packet8, 4), 4u);
    EXPECT_EQ(packets(Method::packet16, 16), 0u);
    EXPECT_EQ(packets(Method::packet8, 16), 0u);
    EXPECT_EQ(packets(Method::packet16, 0), 0u) << "of an older result: not known";
    EXPECT_EQ(packets(Method::stream, 8), 0u);
}

TEST_F(BenchTables, a_row_without_an_answer_has_no_empty_group_in_json)
{
    result_.rows[0].outcome = Failed{ErrorKind::internal, "no scene"};
    const nlohmann::json row = row_json(RowFacts(result_.rows[0]));
    for (const char* group : {"counts", "visits", "verification", "times", "rates", "hit_hash"})
        EXPECT_FALSE(row.contains(group)) << group;
    EXPECT_EQ(row.at("reason"), "no scene");
}
