#include "bench/reproduce/tables/paper_table.h"

#include "bench/terminal/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr std::array label_keys = {"scene", "build", "method", "layout", "device"};

const Quantity* quantity(const PaperCell& cell)
{
    return std::get_if<Quantity>(&cell);
}

void set_finite(json& object, const char* key, std::optional<double> value)
{
    if (value && std::isfinite(*value)) object[key] = *value;
}

json quantity_json(const Quantity& number)
{
    json object = json::object();
    set_finite(object, "value", number.ours.value);
    set_finite(object, "low", number.ours.low);
    set_finite(object, "high", number.ours.high);
    set_finite(object, "paper", number.paper);
    set_finite(object, "ratio", number.ratio());
    return object;
}

json columns_json(const PaperTable& table)
{
    json columns = json::array();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const Column& column = table.columns[c];
        columns.push_back({{"key", column.key}, {"title", column.title}});
        if (!column.unit.empty()) columns.back()["unit"] = column.unit;
        const auto is_number = [&](const auto& row) { return quantity(row[c]) != nullptr; };
        if (std::ranges::any_of(table.rows, is_number)) columns.back()["decimals"] = column.decimals;
    }
    return columns;
}

json rows_json(const PaperTable& table)
{
    json rows = json::array();
    for (const auto& cells : table.rows) {
        json row = json::object();
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const std::string& key = table.columns[c].key;
            if (const auto* text = std::get_if<std::string>(&cells[c])) row[key] = *text;
            if (const auto* number = quantity(cells[c])) row[key] = quantity_json(*number);
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

json axis_json(const PaperFigure::Axis& axis)
{
    json object = {{"title", axis.title}, {"unit", axis.unit}};
    if (axis.logarithmic) object["scale"] = "logarithmic";
    return object;
}

/// A coordinate with seven digits: points are drawn, and rows have the exact numbers. All digits took a seventh of a
/// result of all tables and figures.
double drawn(double coordinate)
{
    return std::strtod(fmt::format("{:.7g}", coordinate).c_str(), nullptr);
}

json claims_json(const std::vector<Claim>& claims)
{
    json list = json::array();
    for (const Claim& claim : claims)
        list.push_back(claim_json(claim));
    return list;
}

/// Whole numbers without decimals.
Cell number_cell(double value, const Column& column)
{
    if (column.decimals == 0 && value >= 0) return static_cast<std::uint64_t>(std::llround(value));
    return value;
}

Cell value_cell(const PaperCell& cell, const Column& column)
{
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* number = quantity(cell)) return number_cell(number->ours.value, column);
    return {};
}

bool has_interval(const PaperCell& cell)
{
    const Quantity* number = quantity(cell);
    return number != nullptr && number->ours.low && number->ours.high;
}

/// "1.25 [1.10, 1.40]"; only the value if there is no interval.
Cell interval_cell(const PaperCell& cell, const Column& column)
{
    if (!has_interval(cell)) return value_cell(cell, column);
    const Estimate& ours = quantity(cell)->ours;
    return fmt::format("{0:.{3}f} [{1:.{3}f}, {2:.{3}f}]", ours.value, *ours.low, *ours.high, column.decimals);
}

Cell paper_cell(const PaperCell& cell, const Column& column)
{
    const Quantity* number = quantity(cell);
    return number != nullptr && number->paper ? number_cell(*number->paper, column) : Cell();
}

Cell ratio_cell(const PaperCell& cell, const Column&)
{
    const Quantity* number = quantity(cell);
    return number != nullptr ? cell_of(number->ratio()) : Cell();
}

void add_claims_and_notes(Sheet& sheet, const std::vector<Claim>& claims, const std::vector<std::string>& notes)
{
    if (!claims.empty()) sheet.gap();
    for (const Claim& claim : claims)
        sheet.prose(fmt::format("{}: {}. {}", claim.text, name_of(claim.verdict), claim.evidence), 2);
    if (!notes.empty()) sheet.gap();
    for (const std::string& note : notes)
        sheet.prose(note, 2);
}

std::string claims_markdown(const std::vector<Claim>& claims)
{
    if (claims.empty()) return {};
    Table table({{"claim", "claim"}, {"verdict", "verdict"}, {"evidence", "evidence"}});
    for (const Claim& claim : claims)
        table.add({claim.text, std::string(name_of(claim.verdict)), claim.evidence});
    return std::string("\n").append(table.markdown());
}

std::string notes_markdown(const std::vector<std::string>& notes)
{
    std::string text;
    for (const std::string& note : notes)
        text += fmt::format("{}- {}\n", text.empty() ? "\n" : "", note);
    return text;
}

/// What a tidy row says, after its labels.
struct Fact {
    std::string quantity, unit = {};
    Cell value = {}, low = {}, high = {}, paper = {}, ratio = {}, x = {};
    std::string verdict = {}, text = {};
};

void add_fact(Table& tidy, std::vector<Cell> labels, const Fact& fact)
{
    labels.resize(1 + label_keys.size());
    labels.insert(labels.end(), {fact.quantity, text_cell(fact.unit), fact.value, fact.low, fact.high, fact.paper,
                                 fact.ratio, fact.x, text_cell(fact.verdict), text_cell(fact.text)});
    tidy.add(std::move(labels));
}

std::vector<Cell> labels_of(const PaperTable& table, const std::vector<PaperCell>& row)
{
    std::vector<Cell> labels = {table.id};
    for (const char* key : label_keys) {
        const auto column = std::ranges::find_if(table.columns, [&](const Column& one) { return one.key == key; });
        const bool has = column != table.columns.end();
        labels.push_back(has ? value_cell(row[static_cast<std::size_t>(column - table.columns.begin())], *column)
                             : Cell());
    }
    return labels;
}

bool is_label(const Column& column)
{
    return std::ranges::find(label_keys, column.key) != label_keys.end();
}

void add_row_facts(Table& tidy, const PaperTable& table, const std::vector<PaperCell>& row)
{
    for (std::size_t c = 0; c < row.size(); ++c) {
        const Column& column = table.columns[c];
        if (const Quantity* number = quantity(row[c]))
            add_fact(tidy, labels_of(table, row),
                     {column.key, column.unit, number->ours.value, cell_of(number->ours.low),
                      cell_of(number->ours.high), cell_of(number->paper), cell_of(number->ratio())});
        else if (const auto* text = std::get_if<std::string>(&row[c]); text != nullptr && !is_label(column))
            add_fact(tidy, labels_of(table, row), {.quantity = column.key, .text = *text});
    }
}

void add_points(Table& tidy, const PaperFigure& figure)
{
    for (const PaperFigure::Series& series : figure.series)
        for (const auto& [x, y] : series.points)
            add_fact(tidy, {figure.id},
                     {.quantity = figure.y.title,
                      .unit = figure.y.unit,
                      .value = drawn(y),
                      .x = drawn(x),
                      .text = series.name});
}

/// Members that tables and figures share.
template <class Part>
void add_sentences(Table& tidy, const Part& part)
{
    for (const Claim& claim : part.claims)
        add_fact(tidy, {part.id},
                 {.quantity = claim.id, .verdict = std::string(name_of(claim.verdict)), .text = claim.evidence});
    for (const std::string& note : part.notes)
        add_fact(tidy, {part.id}, {.quantity = "note", .text = note});
}

/// The figure's notes, and where to find its points, which no text contains.
std::vector<std::string> notes_of(const PaperFigure& figure)
{
    std::vector<std::string> notes = figure.notes;
    std::size_t points = 0;
    for (const PaperFigure::Series& series : figure.series)
        points += series.points.size();
    if (points > 0)
        notes.push_back(fmt::format("The {} points are in the result's CSV and JSON.", with_commas(points)));
    return notes;
}

std::string headline(const std::string& id, const std::string& title, const std::string& source)
{
    return fmt::format("{}: {} ({})", id, title, source);
}

} // namespace

std::optional<double> Quantity::ratio() const
{
    if (!paper || *paper == 0 || !is_compared) return std::nullopt;
    return ours.value / *paper;
}

PaperCell known_number(std::optional<double> value)
{
    return value ? exact_cell(*value) : PaperCell();
}

std::vector<PaperCell> label_cells(std::vector<PaperCell> first, const RowRecord& row)
{
    first.insert(first.end(), {std::string(name_of(row.key.kernel.method)), std::string(name_of(row.key.kernel.layout)),
                               device_label(row.key), known_text(device_kind_text(row))});
    return first;
}

std::vector<Column> with_labels(const std::vector<Column>& others)
{
    std::vector<Column> columns = {{"scene", "scene"},   {"build", "build"},   {"method", "method"},
                                   {"layout", "layout"}, {"device", "device"}, {"type", "type"}};
    columns.insert(columns.end(), others.begin(), others.end());
    return columns;
}

PaperCell known_text(std::string text)
{
    return text.empty() ? PaperCell() : PaperCell(std::move(text));
}

PaperCell exact_cell(double value, std::optional<double> paper)
{
    return Quantity{{value, {}, {}, true}, paper};
}

nlohmann::json table_json(const PaperTable& table)
{
    return {{"id", table.id},           {"title", table.title},
            {"source", table.source},   {"columns", columns_json(table)},
            {"rows", rows_json(table)}, {"claims", claims_json(table.claims)},
            {"notes", table.notes}};
}

nlohmann::json figure_json(const PaperFigure& figure)
{
    json series = json::array();
    for (const PaperFigure::Series& one : figure.series) {
        json points = json::array();
        for (const auto& [x, y] : one.points)
            points.push_back({drawn(x), drawn(y)});
        series.push_back({{"name", one.name}, {"points", std::move(points)}});
    }
    return {{"id", figure.id},
            {"title", figure.title},
            {"source", figure.source},
            {"x", axis_json(figure.x)},
            {"y", axis_json(figure.y)},
            {"series", std::move(series)},
            {"claims", claims_json(figure.claims)},
            {"pictures", figure.pictures},
            {"notes", figure.notes}};
}

Table with_paper_columns(const PaperTable& table)
{
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows(table.rows.size());
    const auto add = [&](const Column& column, const std::vector<Cell>& cells, bool even_empty) {
        const auto is_empty = [](const Cell& cell) { return std::holds_alternative<std::monostate>(cell); };
        if (!even_empty && std::ranges::all_of(cells, is_empty)) return;
        columns.push_back(column);
        for (std::size_t r = 0; r < rows.size(); ++r)
            rows[r].push_back(cells[r]);
    };
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const Column& column = table.columns[c];
        const auto cells = [&](const auto& make) {
            std::vector<Cell> list;
            for (const auto& row : table.rows)
                list.push_back(make(row.at(c), column));
            return list;
        };
        const bool intervals =
            std::ranges::any_of(table.rows, [&](const auto& row) { return has_interval(row.at(c)); });
        add(column, intervals ? cells(interval_cell) : cells(value_cell), true);
        add({column.key + "_paper", "paper", {}, column.decimals}, cells(paper_cell), false);
        add({column.key + "_ratio", "ratio", {}, 3}, cells(ratio_cell), false);
    }
    Table result(std::move(columns));
    for (auto& row : rows)
        result.add(std::move(row));
    return result;
}

Table tidy_table(const std::vector<PaperTable>& tables, const std::vector<PaperFigure>& figures)
{
    std::vector<Column> columns = {{"table", "table"}};
    for (const char* key : label_keys)
        columns.push_back({key, key});
    for (const char* key : {"quantity", "unit", "value", "low", "high", "paper", "ratio", "x", "verdict", "text"})
        columns.push_back({key, key});
    Table tidy(std::move(columns));
    for (const PaperTable& table : tables) {
        for (const auto& row : table.rows)
            add_row_facts(tidy, table, row);
        add_sentences(tidy, table);
    }
    for (const PaperFigure& figure : figures) {
        add_points(tidy, figure);
        add_sentences(tidy, figure);
    }
    return tidy;
}

Sheet table_sheet(const PaperTable& table)
{
    Sheet sheet;
    sheet.heading(headline(table.id, table.title, table.source));
    sheet.gap();
    sheet.table(with_paper_columns(table));
    add_claims_and_notes(sheet, table.claims, table.notes);
    sheet.gap();
    return sheet;
}

std::string table_markdown(const PaperTable& table)
{
    return "## " + headline(table.id, table.title, table.source) + "\n\n" + with_paper_columns(table).markdown() +
           claims_markdown(table.claims) + notes_markdown(table.notes) + "\n";
}

Sheet figure_sheet(const PaperFigure& figure)
{
    Sheet sheet;
    sheet.heading(headline(figure.id, figure.title, figure.source));
    add_claims_and_notes(sheet, figure.claims, notes_of(figure));
    for (const std::string& picture : figure.pictures)
        sheet.line("  picture: " + picture);
    sheet.gap();
    return sheet;
}

std::string figure_markdown(const PaperFigure& figure)
{
    std::string text = "## " + headline(figure.id, figure.title, figure.source) + "\n" +
                       claims_markdown(figure.claims) + notes_markdown(notes_of(figure));
    for (const std::string& picture : figure.pictures)
        text += fmt::format("\n![{0}]({0})\n", picture);
    return text + "\n";
}

} // namespace tetrace
