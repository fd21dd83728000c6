#include "bench/show/side_by_side.h"

#include "bench/output/compare_report.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace tetrace {

namespace {

/// "A" for the first result, "B" and so on for those that are compared with it.
std::string letter(std::size_t result)
{
    return std::string(1, static_cast<char>('A' + result));
}

/// The row of that name; null where neither of the two results has it.
const ComparedRow* find_row(const ResultComparison& comparison, const std::string& name)
{
    const auto found =
        std::ranges::find_if(comparison.rows, [&](const ComparedRow& row) { return row.name() == name; });
    return found == comparison.rows.end() ? nullptr : &*found;
}

bool is_compared(const ComparedRow* row)
{
    return row != nullptr && row->outcome == RowOutcome::compared;
}

/// "80.10 (1.03)": a rate, and its ratio to the first result's; else why there is none.
Cell cell_of_result(const ComparedRow* row)
{
    if (row == nullptr) return {};
    if (!is_compared(row)) return row->outcome == RowOutcome::untimed ? Cell() : Cell(row->verdict());
    const std::string rate = row->after->mrays_per_s ? fmt::format("{:.2f}", *row->after->mrays_per_s) : "-";
    return fmt::format("{:>8} ({:.2f}){}", rate, row->change->ratio, row->is_noisy() ? " noisy" : "");
}

/// The names of all rows, those of the first result first.
std::vector<std::string> names_of(const std::vector<ResultComparison>& comparisons)
{
    std::vector<std::string> names;
    for (const ResultComparison& comparison : comparisons)
        for (const ComparedRow& row : comparison.rows)
            if (std::ranges::find(names, row.name()) == names.end()) names.push_back(row.name());
    return names;
}

Table rates_table(const std::vector<ResultComparison>& comparisons)
{
    std::vector<Column> columns = {{"name", "row"}, {.key = "A", .title = "A", .unit = "Mrays/s", .rank = 0}};
    for (std::size_t i = 0; i < comparisons.size(); ++i)
        columns.push_back({.key = letter(i + 1), .title = letter(i + 1), .unit = "Mrays/s (over A)"});
    Table table(std::move(columns));
    for (const std::string& name : names_of(comparisons)) {
        const auto row_in = [&](const ResultComparison& comparison) { return find_row(comparison, name); };
        const auto same = std::ranges::find_if(comparisons, [&](const auto& one) { return is_compared(row_in(one)); });
        if (same == comparisons.end()) continue;
        std::vector<Cell> cells = {name, cell_of(row_in(*same)->before->mrays_per_s)};
        for (const ResultComparison& comparison : comparisons)
            cells.push_back(cell_of_result(row_in(comparison)));
        table.add(std::move(cells));
    }
    return table;
}

/// A note about A and B, with the result's own letter in place of B.
std::string in_letters(std::string note, std::size_t result)
{
    for (std::size_t at = note.find("in B"); at != std::string::npos; at = note.find("in B", at + 4))
        note.replace(at, 4, "in " + letter(result));
    if (note.starts_with("B: ")) note.replace(0, 1, letter(result));
    return note;
}

/// Each reason for which rows are not compared, for all rows that have it.
void add_notes(Sheet& sheet, const std::vector<ResultComparison>& comparisons)
{
    for (std::size_t i = 0; i < comparisons.size(); ++i) {
        std::map<std::string, std::vector<const ComparedRow*>> notes;
        for (const ComparedRow& row : comparisons[i].rows)
            if ((row.outcome != RowOutcome::compared || row.is_noisy()) && row.outcome != RowOutcome::untimed)
                notes[fmt::format("{} in {}: {}", row.verdict(), letter(i + 1), in_letters(row.note(), i + 1))]
                    .push_back(&row);
        for (const auto& [note, rows] : notes)
            sheet.line(rows.size() == 1
                           ? fmt::format("{}: {}", rows.front()->name(), note)
                           : fmt::format("{} rows, such as {}: {}", rows.size(), rows.front()->name(), note));
        if (!notes.empty()) sheet.gap();
    }
}

std::string means_text(const std::vector<ResultComparison>& comparisons)
{
    std::string text;
    for (std::size_t i = 0; i < comparisons.size(); ++i)
        if (const auto mean = comparisons[i].geometric_mean())
            append_item(text, ", ",
                        fmt::format("{} / A {:.3f} over {} rows", letter(i + 1), *mean,
                                    comparisons[i].count(RowOutcome::compared)));
    return text + ": geometric means of the ratios of medians. Verdicts and intervals: 'tetrace compare' of two.";
}

Table flat_table(const std::vector<ResultComparison>& comparisons)
{
    std::vector<Column> columns = flat_rows(comparisons.front()).columns();
    columns.insert(columns.begin(), {"result", "result"});
    Table table(std::move(columns));
    for (std::size_t i = 0; i < comparisons.size(); ++i) {
        const Table pair = flat_rows(comparisons[i]);
        for (const auto& row : pair.rows()) {
            std::vector<Cell> cells = {letter(i + 1)};
            cells.insert(cells.end(), row.begin(), row.end());
            table.add(std::move(cells));
        }
    }
    return table;
}

} // namespace

Report side_by_side(const std::vector<ResultComparison>& comparisons, const Options& options)
{
    Report report{{}, flat_table(comparisons), {}};
    Sheet& sheet = report.sheet;
    sheet.labelled("A", source_text(*comparisons.front().before));
    for (std::size_t i = 0; i < comparisons.size(); ++i)
        sheet.labelled(letter(i + 1), source_text(*comparisons[i].after));
    sheet.gap();
    sheet.table(rates_table(comparisons));
    sheet.gap();
    add_notes(sheet, comparisons);
    add_search_note(sheet, comparisons.front());
    sheet.labelled("Means", means_text(comparisons));
    check_columns(options, sheet.column_keys());
    report.markdown = sheet.markdown({.columns = options.columns});
    if (options.out) sheet.labelled("Result", options.out->string());
    nlohmann::json section = result_head(options);
    section["comparisons"] = nlohmann::json::array();
    for (const ResultComparison& comparison : comparisons)
        section["comparisons"].push_back(comparison_json(comparison, options.allow_missing));
    report.json = {{"tetrace", std::move(section)}};
    return report;
}

} // namespace tetrace
