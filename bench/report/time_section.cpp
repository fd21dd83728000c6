#include "bench/report/sections.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read =
    "Milliseconds for all views. Compiling and uploading are paid once; first: the first pass, in which devices "
    "compile "
    "what they left until then; kernel: device time; launch: launching and waiting, what wall holds beyond the kernel; "
    "download: the hits to the host. Medians of the samples, the one-time figures and the download apart.";

Html milliseconds(const ResultValue& times, const char* key, int decimals = 1)
{
    const auto seconds = times.find(key);
    return seconds ? text(fmt::format("{:.{}f}", 1e3 * seconds->number(), decimals)) : Html();
}

Html size_of(const ResultValue& row)
{
    const auto bytes = row.find("bytes");
    return bytes ? text(fmt::format("{:.1f}", 1e-6 * bytes->number())) : Html();
}

HtmlTable empty_table()
{
    return HtmlTable({{"result"},
                      {"scene"},
                      {"row"},
                      {"API"},
                      {"compile", {}, true},
                      {"upload", {}, true},
                      {"first", {}, true},
                      {"kernel", {}, true},
                      {"launch", {}, true},
                      {"download", {}, true},
                      {"wall", {}, true},
                      {"size", "MB", true}});
}

void add_row(HtmlTable& table, const ReportRow& row, const ResultValue& value, const std::string& letter)
{
    const ResultValue times = value.at("times");
    table.add({text(letter), text(row.row->scene), text(row.kernel_and_rays()), text(row.api),
               milliseconds(times, "compile_s"), milliseconds(times, "upload_s"), milliseconds(times, "first_wall_s"),
               milliseconds(times, "median_s"), milliseconds(times, "overhead_s", 2), milliseconds(times, "download_s"),
               milliseconds(times, "wall_s"), size_of(value)});
}

} // namespace

Section time_section(const ReportInput& input)
{
    HtmlTable table = empty_table();
    std::size_t first = 0; // of the file's rows
    for (std::size_t file = 0; file < input.files.size(); first += input.files[file++].rows.size()) {
        if (input.files[file].rows.empty()) continue;
        const auto values = input.files[file].section().at("rows").items();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (const ReportRow& row = input.rows.at(first + i); row.rate)
                add_row(table, row, values[i], file_letter(file, input.files.size()));
    }
    Section section{"times", "Where the time goes", {}};
    section.content =
        table.empty() ? paragraph("No row of these results was timed.") : note(how_to_read) + table.html();
    return section;
}

} // namespace tetrace
