#include "bench/output/row_fields.h"
#include "bench/report/charts/axis.h"
#include "bench/report/charts/bar_chart.h"
#include "bench/report/html/svg.h"
#include "bench/report/sections.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

namespace tetrace {

namespace {

const char* const how_to_read_rates =
    "Millions of rays per second, from the median sample, kernel time only. The whisker spans the middle half of "
    "the samples, and a tick is a sample; a row is noisy if the whisker exceeds 5 % of its median, or if the "
    "machine was disturbed. Rank only rows of one chart: emulated devices are APIs of GPUs that run on the CPU, and "
    "say nothing about a GPU.";

std::string scene_title(const RowGroup& group)
{
    return rays_title(group.scene, rays_text(group.rays, group.task));
}

/// "45 % of these rays enter the domain, and 16 % hit.", of groups that traced the same rays.
std::string shares_text(std::span<const RowGroup> groups)
{
    for (const RowGroup& group : groups)
        for (const ReportRow* row : group.rows) {
            if (!row->hit_share) continue;
            const std::string hit = percent_text(*row->hit_share);
            if (!row->enter_share) return hit + " of these rays hit.";
            return percent_text(*row->enter_share) + " of these rays enter the domain, and " + hit + " hit.";
        }
    return {};
}

/// The devices of a group, with the results that they come from.
std::set<std::string> devices_in(const RowGroup& group, std::size_t files)
{
    std::set<std::string> devices;
    for (const ReportRow* row : group.rows)
        devices.insert(device_text(*row, files));
    return devices;
}

/// Whether bars must name their devices; the APIs distinguish the emulated devices of one result.
bool needs_devices(const RowGroup& group, std::size_t files)
{
    const bool one_result =
        std::ranges::all_of(group.rows, [&](const ReportRow* row) { return row->file == group.rows.front()->file; });
    return devices_in(group, files).size() > 1 && (group.kind != DeviceKind::emulated || !one_result);
}

BarChart chart_of(const RowGroup& group, std::size_t files)
{
    const bool tell_device = needs_devices(group, files);
    BarChart chart{fmt::format("Rates of the {} on {}", plural_of(group.kind), scene_title(group)), "Mrays/s", {}};
    for (const ReportRow* row : group.rows)
        chart.bars.push_back({row->name(), row->kernel() + "  " + row->api, tell_device ? device_text(*row, files) : "",
                              api_series(row->row->backend), row->rate->mrays_per_s, row->rate->low, row->rate->high,
                              row->rate->samples, remark_of(*row)});
    return chart;
}

std::string group_title(const RowGroup& group, std::size_t files)
{
    if (group.kind == DeviceKind::emulated) return "Emulated on the CPU";
    const auto devices = devices_in(group, files);
    const std::string kind = group.kind == DeviceKind::gpu ? "GPU" : "Processor";
    return devices.size() == 1 ? fmt::format("{}: {}", kind, *devices.begin()) : kind + "s";
}

Html rows_without_rate(const ReportInput& input)
{
    std::vector<const ReportRow*> rows;
    for (const ReportRow& row : input.rows)
        if (!row.rate && input.files.at(row.file).head.verb != "check") rows.push_back(&row);
    return rows.empty() ? Html() : heading("Rows without a rate") + reason_table(rows, input.files.size());
}

std::string anchor_of(const ReportRow& row)
{
    return fmt::format("row-{}-{}", row.file, row.index);
}

} // namespace

std::string device_text(const ReportRow& row, std::size_t files)
{
    return with_letter(row.device, row.file, files);
}

std::string remark_of(const ReportRow& row)
{
    std::string text = row.row->status == Status::flawed ? row.row->reason : "";
    if (is_noisy(row)) text += text.empty() ? "noisy" : ", noisy";
    return text;
}

Html row_link(const ReportRow& row, const Html& content)
{
    return element("a", {{"href", "#" + anchor_of(row)}}, content);
}

std::size_t api_series(const std::string& backend)
{
    // The styles of all_backends(), in their order; later backends get the styles after those.
    constexpr std::array<std::size_t, 6> styles = {0, 2, 3, 4, 5, 1};
    const auto& known = all_backends();
    const auto found = std::ranges::find_if(known, [&](const Backend* b) { return b->name() == backend; });
    const auto place = static_cast<std::size_t>(found - known.begin());
    if (found == known.end()) return series_styles - 1;
    return place < styles.size() ? styles.at(place) : place;
}

Html reason_table(const std::vector<const ReportRow*>& rows, std::size_t files)
{
    std::map<std::array<std::string, 3>, Html> lists;
    for (const ReportRow* row : rows)
        lists[{file_letter(row->file, files), std::string(name_of(row->row->status)), row->row->reason}] +=
            element("li", {{"class", "unrated"}, {"data-row", row->name()}, {"id", anchor_of(*row)}},
                    text(fmt::format("{}: {} {}", row->row->scene, row->kernel(), row->api)));
    HtmlTable table({{"result"}, {"status"}, {"reason"}, {"rows"}});
    for (const auto& [key, list] : lists)
        table.add({text(key[0]), badge(key[1]), text(key[2]), element("ul", {{"class", "plain"}}, list)});
    return table.html();
}

Section rate_section(const ReportInput& input)
{
    Section section{"rates", "Rates", {}};
    const auto groups = rated_groups(input.files, input.rows);
    if (!groups.empty()) section.content += note(how_to_read_rates);
    for (std::size_t begin = 0; begin < groups.size();) {
        const std::string title = scene_title(groups[begin]);
        Html charts;
        std::size_t end = begin;
        for (; end < groups.size() && groups[end].scene.hash == groups[begin].scene.hash &&
               scene_title(groups[end]) == title;
             ++end)
            charts += figure(group_title(groups[end], input.files.size()),
                             draw(chart_of(groups[end], input.files.size())), "");
        const std::string shares = shares_text(std::span(groups).subspan(begin, end - begin));
        section.content += heading(title) + (shares.empty() ? Html() : note(shares)) + side_by_side(charts);
        begin = end;
    }
    section.content += rows_without_rate(input);
    return section;
}

namespace {

const char* const how_to_read_times =
    "Milliseconds for all views. Compiling and uploading happen once. first: the first pass, in which devices "
    "compile what is left; kernel: device time; launch: launching and waiting, which is the rest of the wall time; "
    "download: the hits to the host. Medians of the samples, except for the one-time figures and the download.";

/// Empty if the row lacks the value.
Cell cell_of_field(const RowField& field, const ResultValue& row)
{
    const auto value = row.find(field);
    if (!value) return {};
    try {
        return field.report.cell(value->json());
    } catch (const nlohmann::json::type_error&) {
        value->reject("is of another type than this field");
    }
}

std::vector<Column> all_columns()
{
    std::vector<Column> columns = {{"result", "result"}, {"scene", "scene"}, {"row", "row"}, {"api", "API"}};
    for (Column& column : columns_of(&RowField::report))
        columns.push_back(std::move(column));
    return columns;
}

void add_row(Table& table, const ReportRow& row, const ResultValue& value, const std::string& letter)
{
    std::vector<Cell> cells = {letter, row.row->scene, row.kernel_and_rays(), row.api};
    for (const RowField& field : row_fields())
        if (field.report.title != nullptr) cells.push_back(cell_of_field(field, value));
    table.add(std::move(cells));
}

} // namespace

Section time_section(const ReportInput& input)
{
    Table table(all_columns());
    std::size_t first = 0; // of the file's rows
    for (std::size_t file = 0; file < input.files.size(); first += input.files[file++].rows.size()) {
        if (input.files[file].rows.empty()) continue;
        const auto values = input.files[file].section().at("rows").items();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (const ReportRow& row = input.rows.at(first + i); row.rate)
                add_row(table, row, values[i], file_letter(file, input.files.size()));
    }
    Section section{"times", "Where the time goes", {}};
    if (!table.rows().empty()) section.content = note(how_to_read_times) + html_table(table).html();
    return section;
}

} // namespace tetrace
