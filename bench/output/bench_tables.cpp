#include "bench/output/bench_report.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace tetrace {

namespace {

/// The rows' indices, ordered by device; rows that were not opened come last.
std::vector<std::size_t> by_device(const BenchResult& result)
{
    const auto& rows = result.rows;
    std::vector<std::size_t> places(rows.size()), order(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        places[i] = device_of(rows[i], result.devices).value_or(result.devices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
    return order;
}

/// The heading of rows: rows under one heading may be ranked with each other.
std::string heading_of(const RowRecord& row, const std::vector<RowDevice>& devices)
{
    if (!device_of(row, devices)) return "not run";
    if (row.device.kind == DeviceKind::emulated) return "emulated on the CPU, not to be ranked with GPUs";
    return fmt::format("{} ({})", row.device.name, name_of(row.device.kind));
}

/// Adds a heading where consecutive rows run on different hardware.
class Headings {
public:
    Headings(Table& table, const BenchResult& result) : table_(&table), result_(&result)
    {
        std::set<std::string> all;
        for (const RowRecord& row : result.rows)
            if (!std::holds_alternative<Skipped>(row.outcome)) all.insert(heading_of(row, result.devices));
        needed_ = all.size() > 1;
    }

    void before(const RowRecord& row)
    {
        std::string heading = heading_of(row, result_->devices);
        if (needed_ && heading != last_) table_->add_heading(heading);
        last_ = std::move(heading);
    }

private:
    Table* table_;
    const BenchResult* result_;
    bool needed_ = false;
    std::string last_;
};

/// What the rows' rates are compared with: "openmp", or "reference" where the rows have different ones.
std::string reference_name(const std::vector<RowFacts>& rows)
{
    std::set<std::string> references;
    for (const RowFacts& facts : rows)
        if (facts.comparison) references.insert(facts.comparison->reference->key.backend);
    return references.size() == 1 ? *references.begin() : "reference";
}

} // namespace

std::vector<RowFacts> facts_of(const BenchResult& result)
{
    std::vector<RowFacts> all;
    for (const RowRecord& row : result.rows) {
        RowFacts& facts = all.emplace_back(row);
        facts.comparison = result.comparisons.at(all.size() - 1);
        facts.best_bvh = result.best_bvhs.at(all.size() - 1);
        facts.paid_build = paid_build(row, facts.best_bvh);
        facts.ratio_to_single = ratio_to_single(row, result.rows);
        facts.copy_shares = copy_shares(row, result.devices);
    }
    return all;
}

Table rate_table(const std::string& scene, const BenchResult& result)
{
    const auto rows = facts_of(result);
    Table table(columns_of(&RowField::rates, reference_name(rows)));
    Headings headings(table, result);
    for (const std::size_t i : by_device(result)) {
        if (rows[i].row->key.scene != scene || std::holds_alternative<Skipped>(rows[i].row->outcome)) continue;
        headings.before(*rows[i].row);
        table.add(cells_of(&RowField::rates, rows[i]));
    }
    return table;
}

Table time_table(const BenchResult& result)
{
    const auto rows = facts_of(result);
    Table table(columns_of(&RowField::times));
    for (const nlohmann::json& scene : result.scenes) {
        const auto name = scene.at("name").get<std::string>();
        table.add_heading(name);
        for (const std::size_t i : by_device(result))
            if (rows[i].row->key.scene == name && rows[i].figures) table.add(cells_of(&RowField::times, rows[i]));
    }
    return table;
}

Table device_table(const std::vector<RowDevice>& devices)
{
    Table table({{"backend", "backend"},
                 {"implementation", "device"},
                 {"type", "type"},
                 {"copy", "copy", "GB/s", 1},
                 {"launch", "launch", "us", 1},
                 {"self_test", "self-test"},
                 {"division", "division", "ulp"},
                 {"square_root", "root", "ulp"},
                 {"denormals", "denormals"},
                 {"problem", "problem"}});
    std::optional<std::size_t> hardware;
    for (const RowDevice& device : devices) {
        if (hardware != device.hardware) table.add_heading(device.device.name);
        hardware = device.hardware;
        const SelfTest* test = device.self_tests.empty() ? nullptr : &device.self_tests.begin()->second;
        const std::string verdict = test != nullptr ? test->text().substr(0, test->text().find(';')) : "";
        table.add({device_label({{}, device.backend, {}, {}, {}, device.index}), device.device.implementation,
                   std::string(name_of(device.device.kind)),
                   device.yardstick ? Cell(1e-9 * device.yardstick->copy_bytes_per_s) : Cell(),
                   device.yardstick ? Cell(1e6 * device.yardstick->launch_s) : Cell(), text_cell(verdict),
                   test != nullptr ? Cell(std::uint64_t{test->division_ulps}) : Cell(),
                   test != nullptr ? Cell(std::uint64_t{test->square_root_ulps}) : Cell(),
                   test != nullptr ? Cell(test->denormals_kept ? "kept" : "flushed") : Cell(),
                   text_cell(device.problem)});
    }
    return table;
}

std::vector<std::string> bench_columns()
{
    Sheet sheet;
    sheet.table(Table(columns_of(&RowField::rates)));
    sheet.table(Table(columns_of(&RowField::times)));
    sheet.table(device_table({}));
    return sheet.column_keys();
}

Table flat_table(const BenchResult& result, const RunOrigin& origin)
{
    Table table(columns_of(&RowField::csv));
    for (RowFacts& facts : facts_of(result)) {
        facts.origin = &origin;
        table.add(cells_of(&RowField::csv, facts));
    }
    return table;
}

} // namespace tetrace
