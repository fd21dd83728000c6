#include "bench/output/row_fields.h"
#include "bench/report/sections.h"

namespace tetrace {

namespace {

const char* const how_to_read_times =
    "Milliseconds for all views. Compiling and uploading happen once. first: the first pass, in which devices "
    "compile what is left; kernel: device time; launch: launching and waiting, which is the rest of the wall time; "
    "download: the hits to the host. Medians of the samples, except for the one-time figures and the download.";

/// Empty if the row has no such value.
Cell cell_of_field(const RowField& field, const ResultValue& row)
{
    const auto group = *field.group == '\0' ? row : row.find(field.group);
    const auto value = group ? group->find(field.key) : std::nullopt;
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
    section.is_empty = table.rows().empty();
    section.content = table.rows().empty() ? paragraph("No row of these results was timed.")
                                           : note(how_to_read_times) + html_table(table).html();
    return section;
}

} // namespace tetrace
