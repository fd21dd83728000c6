#include "bench/output/axis_lines.h"
#include "bench/report/charts/line_chart.h"
#include "bench/report/sections.h"
#include "bench/rows/sized_scene.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_sizes =
    "Each row at each size of --size. A launch and a million rays: the line through the medians of the smallest and "
    "the "
    "largest size, time = launches x a launch + rays x a ray; without the cost of a launch if the samples do not show "
    "it. Rays of larger images are closer to each other, which makes them faster, too.";
const char* const how_to_read_threads =
    "Each row of a processor with each number of --threads. Of ideal: the speed-up from the fewest to the most "
    "threads, "
    "over the ratio of their numbers. Cores that share a unit, clocks and memory keep it below 100 %.";

/// More lines than these are hard to read; the table has all.
constexpr std::size_t max_lines_of_axis = 14;

/// The lines of each chart by its title: rows of one result, scene and kind of device.
using AxisCharts = std::vector<std::pair<std::string, std::vector<AxisLine>>>;

AxisRate rate_of_row(const ReportRow& row, const ResultScene& scene)
{
    const double median_mrays = row.rate->mrays_per_s * quantile(row.row->samples_s, 0.5);
    const auto launches = row.row->launches > 0 ? row.row->launches : scene.views.size();
    return axis_rate(row.rate->mrays_per_s, median_mrays, static_cast<double>(launches), row.row->samples_s);
}

/// What is measured along one axis. value_of(line, row, scene, file): the row's place; takes the axis out of the line's
/// names. Empty if the row is not on the axis.
template <class ValueOf>
AxisCharts charts_along(const ReportInput& input, const ValueOf& value_of)
{
    std::vector<std::pair<std::string, AxisLines>> found;
    for (const ReportRow& row : input.rows) {
        if (!row.rate || row.row->samples_s.empty()) continue;
        const ResultFile& file = input.files[row.file];
        const ResultScene& scene = scene_of(file, *row.row);
        AxisLine line{scene.name, row.kernel_and_rays(), row.row->api(), {}};
        const auto value = value_of(line, row, scene, file);
        if (!value) continue;
        const std::string title =
            with_letter(fmt::format("{}, {}", line.scene, plural_of(row.kind())), row.file, input.files.size());
        line.scene.clear(); // the chart's title has it
        auto chart = std::ranges::find(found, title, &std::pair<std::string, AxisLines>::first);
        if (chart == found.end()) chart = found.insert(found.end(), {title, {}});
        chart->second.add(line, *value, rate_of_row(row, scene));
    }
    AxisCharts charts;
    for (const auto& [title, lines] : found)
        if (auto whole = lines.whole(); !whole.empty()) charts.emplace_back(title, std::move(whole));
    return charts;
}

/// Those that end highest.
std::vector<AxisLine> drawn(std::vector<AxisLine> lines)
{
    std::ranges::stable_sort(lines, std::greater(), [](const AxisLine& line) { return line.last().mrays_per_s; });
    if (lines.size() > max_lines_of_axis) lines.resize(max_lines_of_axis);
    return lines;
}

std::string caption_of(const std::vector<AxisLine>& lines)
{
    return lines.size() <= max_lines_of_axis
               ? std::string()
               : fmt::format("The {} fastest of {} rows.", max_lines_of_axis, lines.size());
}

template <class Y>
std::vector<Series> series_of(const std::vector<AxisLine>& lines, const Y& y)
{
    std::vector<Series> all;
    for (const AxisLine& line : lines) {
        Series& series = all.emplace_back(Series{line.row + "  " + line.backend, {}});
        for (const auto& [value, rate] : line.rates)
            series.points.emplace_back(static_cast<double>(value.number), y(line, rate));
    }
    return all;
}

Html size_chart(const std::string& title, const std::vector<AxisLine>& lines)
{
    LineChart chart{"Rate by image size: " + title, "rays in an image", "Mrays/s",
                    series_of(drawn(lines), [](const AxisLine&, const AxisRate& rate) { return rate.mrays_per_s; })};
    chart.x_logarithmic = true;
    return figure(title, draw(chart), caption_of(lines));
}

/// Relative to a row's fewest threads, so that one ideal line is that of all.
Html thread_chart(const std::string& title, const std::vector<AxisLine>& lines)
{
    LineChart chart{"Speed-up by threads: " + title, "threads", "speed-up, if that of the fewest threads is ideal",
                    series_of(drawn(lines), [](const AxisLine& line, const AxisRate& rate) {
                        return rate.mrays_per_s / line.first().mrays_per_s *
                               static_cast<double>(line.rates.begin()->first.number);
                    })};
    Series ideal{"ideal", {}};
    for (const AxisLine& line : lines)
        for (const auto& [value, rate] : line.rates)
            ideal.points.emplace_back(static_cast<double>(value.number), static_cast<double>(value.number));
    std::ranges::sort(ideal.points);
    ideal.points.erase(std::unique(ideal.points.begin(), ideal.points.end()), ideal.points.end());
    chart.series.push_back(std::move(ideal));
    chart.x_whole = true;
    return figure(title, draw(chart), caption_of(lines));
}

template <class Chart>
Html parts_of(const AxisCharts& charts, const char* how_to_read, const Chart& chart_of,
              Table (*table_of)(const std::vector<AxisLine>&))
{
    Html drawings, tables;
    for (const auto& [title, lines] : charts) {
        drawings += chart_of(title, lines);
        tables += heading(title) + html_table(table_of(lines)).html();
    }
    return charts.empty() ? Html() : note(how_to_read) + side_by_side(drawings) + tables;
}

} // namespace

Section size_section(const ReportInput& input)
{
    const auto charts = charts_along(input,
                                     [](AxisLine& line, const ReportRow& row, const ResultScene& scene,
                                        const ResultFile&) -> std::optional<AxisValue> {
                                         const std::string size = size_in(scene.name);
                                         if (size.empty()) return std::nullopt;
                                         line.scene = scene.name.substr(0, scene.name.size() - size.size());
                                         line.backend = row.api;
                                         return size_value(scene.width, scene.height);
                                     });
    return {"sizes", "Rates by image size", parts_of(charts, how_to_read_sizes, size_chart, size_table)};
}

Section thread_section(const ReportInput& input)
{
    const auto charts = charts_along(
        input,
        [](AxisLine&, const ReportRow& row, const ResultScene&, const ResultFile& file) -> std::optional<AxisValue> {
            const auto threads = row.row->threads > 0 ? row.row->threads : file.head.threads.value_or(0);
            return threads == 0 ? std::nullopt : std::optional(thread_value(threads));
        });
    return {"threads", "Rates by threads", parts_of(charts, how_to_read_threads, thread_chart, thread_table)};
}

} // namespace tetrace
