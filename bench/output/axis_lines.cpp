#include "bench/output/axis_lines.h"

#include "bench/measuring/figures.h"
#include "bench/rows/sized_scene.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace tetrace {

AxisRate axis_rate(double mrays_per_s, double mrays, double launches, const std::vector<double>& samples_s)
{
    AxisRate rate{mrays_per_s, {launches / mrays, {}}};
    for (const double seconds : samples_s)
        rate.per_mray.seconds.push_back(seconds / mrays);
    return rate;
}

double AxisLine::efficiency() const
{
    const auto from = static_cast<double>(rates.begin()->first.number);
    const auto to = static_cast<double>(rates.rbegin()->first.number);
    return last().mrays_per_s / first().mrays_per_s * from / to;
}

void AxisLines::add(const AxisLine& line, AxisValue value, AxisRate rate)
{
    const auto known = std::ranges::find_if(lines_, [&](const AxisLine& other) {
        return other.scene == line.scene && other.row == line.row && other.backend == line.backend;
    });
    AxisLine& found = known == lines_.end() ? lines_.emplace_back(line) : *known;
    found.rates.emplace(std::move(value), std::move(rate));
}

std::vector<AxisLine> AxisLines::whole() const
{
    std::vector<AxisLine> lines;
    std::ranges::copy_if(lines_, std::back_inserter(lines), [](const AxisLine& line) { return line.rates.size() > 1; });
    return lines;
}

AxisValue size_value(std::uint64_t width, std::uint64_t height)
{
    return {width * height, fmt::format("{}x{}", width, height)};
}

AxisValue thread_value(std::uint64_t threads)
{
    return {threads, counted(threads, "thread", "threads")};
}

namespace {

AxisRate rate_of_record(const RowRecord& row)
{
    return axis_rate(figures_of(row)->mrays_per_s, 1e-6 * static_cast<double>(traced(row)->totals.rays),
                     row.launches.joined, row.samples_s);
}

/// Shows a table's columns in the order of the axis.
std::set<AxisValue> places_of(const std::vector<AxisLine>& lines)
{
    std::set<AxisValue> values;
    for (const AxisLine& line : lines)
        for (const auto& [value, rate] : line.rates)
            values.insert(value);
    return values;
}

/// A line of the table for each line of the axis: its rates, and the other columns' cells.
template <class MoreCells>
Table axis_table(const std::vector<AxisLine>& lines, const std::vector<Column>& more, const MoreCells& more_cells)
{
    const auto values = places_of(lines);
    std::vector<Column> columns = {{"row", "row"}, {.key = "backend", .title = "backend", .rank = 0}};
    for (const AxisValue& value : values)
        columns.push_back({"mrays_per_s at " + value.text, value.text, "Mrays/s"});
    columns.insert(columns.end(), more.begin(), more.end());
    Table table(columns);
    std::string scene;
    for (const AxisLine& line : lines) {
        if (line.scene != scene) table.add_heading(line.scene);
        scene = line.scene;
        std::vector<Cell> cells = {line.row, line.backend};
        for (const AxisValue& value : values) {
            const auto rate = line.rates.find(value);
            cells.push_back(rate == line.rates.end() ? Cell() : Cell(rate->second.mrays_per_s));
        }
        for (Cell& cell : more_cells(line))
            cells.push_back(std::move(cell));
        table.add(std::move(cells));
    }
    return table;
}

} // namespace

std::vector<AxisLine> size_lines(const BenchResult& result)
{
    AxisLines lines;
    for (const nlohmann::json& json : result.scenes) {
        const ResultValue scene(json, "scene");
        const std::string label = scene.at("name").line(), size = size_in(label);
        if (size.empty()) continue;
        const AxisValue value = size_value(scene.at("width").count(), scene.at("height").count());
        const std::string name = label.substr(0, label.size() - size.size());
        for (const RowRecord* row : rows_of(label, result.rows))
            if (figures_of(*row))
                lines.add({name, kernel_title(row->key), device_label(row->key), {}}, value, rate_of_record(*row));
    }
    return lines.whole();
}

std::vector<AxisLine> thread_lines(const BenchResult& result)
{
    AxisLines lines;
    for (const RowRecord& row : result.rows) {
        if (!figures_of(row)) continue;
        RowKey key = row.key;
        const unsigned threads = std::exchange(key.threads, 0);
        lines.add({key.scene, kernel_title(key), device_label(key), {}},
                  thread_value(threads == 0 ? result.threads : threads), rate_of_record(row));
    }
    return lines.whole();
}

Table size_table(const std::vector<AxisLine>& lines)
{
    return axis_table(
        lines, {{"launch_us", "a launch", "us"}, {"mray_ms", "a million rays", "ms", 3}}, [](const AxisLine& line) {
            const LaunchLine cost = launch_line(line.last().per_mray, line.first().per_mray, 1);
            return std::vector<Cell>{cost.fixed_s ? Cell(1e6 * *cost.fixed_s) : Cell(), 1e3 * cost.s_per_unit};
        });
}

Table thread_table(const std::vector<AxisLine>& lines)
{
    return axis_table(lines, {{"of_ideal", "of ideal", "%", 0}},
                      [](const AxisLine& line) { return std::vector<Cell>{100 * line.efficiency()}; });
}

} // namespace tetrace
