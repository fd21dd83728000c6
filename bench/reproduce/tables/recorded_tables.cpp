#include "bench/reproduce/tables/recorded_tables.h"

#include "bench/output/report.h"

#include "core/base/printable.h"

#include <algorithm>

namespace tetrace {

namespace {

std::string shown_at(const ResultValue& object, const char* key)
{
    return printable_text(object.text_at(key));
}

/// The numbers of a table have so few decimals that no format fails.
int shown_decimals(const ResultValue& column)
{
    const auto decimals = column.find("decimals");
    return decimals ? static_cast<int>(std::min<std::uint64_t>(decimals->count(), 15)) : Column{}.decimals;
}

std::vector<Column> read_columns(const ResultValue& table)
{
    std::vector<Column> columns;
    for (const ResultValue& column : table.at("columns").items())
        columns.push_back(
            {column.at("key").line(), shown_at(column, "title"), shown_at(column, "unit"), shown_decimals(column)});
    return columns;
}

std::optional<double> number_at(const ResultValue& object, const char* key)
{
    const auto number = object.find(key);
    return number ? std::optional(number->number()) : std::nullopt;
}

/// An object without a value has had one that is not finite.
PaperCell read_cell(const ResultValue& cell)
{
    if (cell.json().is_string()) return printable_text(cell.text());
    if (cell.json().is_number()) return exact_cell(cell.number());
    const auto value = number_at(cell, "value");
    if (!value) return known_text(shown_at(cell, "text"));
    const bool is_compared = cell.find("ratio").has_value();
    return Quantity{{*value, number_at(cell, "low"), number_at(cell, "high")}, number_at(cell, "paper"), is_compared};
}

std::vector<Claim> read_claims(const ResultValue& part)
{
    std::vector<Claim> claims;
    const auto list = part.find("claims");
    if (!list) return claims;
    for (const ResultValue& value : list->items()) {
        Claim claim{value.at("id").line(), shown_at(value, "text"), {}, shown_at(value, "evidence")};
        const ResultValue verdict = value.at("verdict");
        const auto verdicts = values_of<ClaimVerdict>();
        const auto found = std::ranges::find(verdicts, verdict.line(), [](ClaimVerdict v) { return name_of(v); });
        if (found == verdicts.end()) verdict.reject("is not a verdict");
        claim.verdict = *found;
        claims.push_back(std::move(claim));
    }
    return claims;
}

std::vector<std::string> read_texts(const ResultValue& part, const char* key)
{
    std::vector<std::string> texts;
    if (const auto list = part.find(key))
        for (const ResultValue& text : list->items())
            texts.push_back(printable_text(text.text()));
    return texts;
}

PaperTable read_table(const ResultValue& value)
{
    PaperTable table{value.at("id").line(), shown_at(value, "title"),   shown_at(value, "source"),
                     read_columns(value),   read_texts(value, "notes"), read_claims(value)};
    for (const ResultValue& row : value.at("rows").items()) {
        auto& cells = table.rows.emplace_back();
        for (const Column& column : table.columns) {
            const auto cell = row.find(column.key);
            cells.push_back(cell ? read_cell(*cell) : PaperCell());
        }
    }
    return table;
}

/// What text shows of a figure: all but its axes.
PaperFigure read_figure(const ResultValue& value)
{
    PaperFigure figure{value.at("id").line(),
                       shown_at(value, "title"),
                       shown_at(value, "source"),
                       {},
                       {},
                       read_texts(value, "notes"),
                       {},
                       read_claims(value),
                       read_texts(value, "pictures")};
    for (const ResultValue& series : value.at("series").items())
        figure.series.push_back(
            {shown_at(series, "name"), std::vector<std::pair<double, double>>(series.at("points").items().size())});
    return figure;
}

void add_closing_lines(Sheet& sheet, const PaperTables& all)
{
    if (all.interrupted) sheet.labelled("Stopped", interrupted_sentence);
    for (const auto& sentences : {all.missing_scenes, all.missing_devices})
        for (const std::string& sentence : sentences)
            sheet.labelled("Missing", sentence);
    if (!all.trust.empty()) sheet.labelled("Trust", all.trust);
}

} // namespace

Sheet tables_sheet(const PaperTables& all)
{
    Sheet sheet;
    for (const PaperTable& table : all.tables)
        sheet.append(table_sheet(table));
    for (const PaperFigure& figure : all.figures)
        sheet.append(figure_sheet(figure));
    add_closing_lines(sheet, all);
    return sheet;
}

std::string tables_markdown(const PaperTables& all)
{
    std::string text;
    for (const PaperTable& table : all.tables)
        text += table_markdown(table);
    for (const PaperFigure& figure : all.figures)
        text += figure_markdown(figure);
    Sheet closing;
    add_closing_lines(closing, all);
    return text + closing.markdown();
}

PaperTables read_tables(const ResultValue& section)
{
    PaperTables all;
    if (const auto tables = section.find("tables"))
        for (const ResultValue& table : tables->items())
            all.tables.push_back(read_table(table));
    if (const auto figures = section.find("figures"))
        for (const ResultValue& figure : figures->items())
            all.figures.push_back(read_figure(figure));
    all.missing_scenes = read_texts(section, "missing_scenes");
    all.missing_devices = read_texts(section, "missing_devices");
    all.interrupted = section.find("interrupted").has_value();
    return all;
}

} // namespace tetrace
