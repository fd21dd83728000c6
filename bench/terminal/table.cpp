#include "bench/terminal/table.h"

#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <ranges>

namespace tetrace {

namespace {

constexpr std::string_view gap = "  "; // between columns

template <class... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

std::string padded(const std::string& text, std::size_t width, bool right, bool coloured = false)
{
    const std::string blanks(width - std::min(width, display_width(text)), ' ');
    const std::string shown = coloured ? in_colour(text) : text;
    return right ? blanks + shown : shown + blanks;
}

std::string without_trailing_blanks(std::string line)
{
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

std::string quoted(const std::string& text)
{
    // Spreadsheets would evaluate a cell that begins so and is not a number; after an apostrophe they show it.
    const bool begins_formula = text.find_first_of("=+-@\t\r") == 0;
    if (begins_formula && text.find_first_not_of("+-.0123456789 %") != std::string::npos) return quoted("'" + text);
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

std::string csv_cell(const Cell& cell)
{
    return std::visit(Overloaded{[](std::monostate) { return std::string(); },
                                 [](const std::string& text) { return quoted(text); },
                                 [](std::uint64_t value) { return std::to_string(value); },
                                 [](double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }},
                      cell);
}

std::string in_markdown(const std::string& text)
{
    std::string result;
    for (const char c : text)
        result += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
    return result;
}

using Lines = std::vector<std::string>;

/// The text in lines of at most `width` columns, broken after '_', '/', ',' and blanks; a longer piece without any of
/// them is a line all the same.
Lines folded(const std::string& text, std::size_t width)
{
    Lines lines = {""};
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find_first_of("_/, ", begin), text.size() - 1) + 1;
        const std::string piece = text.substr(begin, end - begin);
        if (!lines.back().empty() && display_width(lines.back() + piece) > width) lines.emplace_back();
        lines.back() += piece;
        begin = end;
    }
    return lines;
}

/// A column as it is printed: each cell in one line or more.
struct ShownColumn {
    Lines title;
    std::string unit;
    std::vector<Lines> cells;
    bool right = false, coloured = false;

    [[nodiscard]] std::size_t cell_width() const
    {
        std::size_t widest = display_width(unit);
        for (const Lines& cell : cells)
            for (const std::string& line : cell)
                widest = std::max(widest, display_width(line));
        return widest;
    }
    [[nodiscard]] std::size_t width() const
    {
        std::size_t widest = cell_width();
        for (const std::string& line : title)
            widest = std::max(widest, display_width(line));
        return widest;
    }
};

std::size_t width_of_all(const std::vector<ShownColumn>& columns)
{
    std::size_t width = columns.empty() ? 0 : gap.size() * (columns.size() - 1);
    for (const ShownColumn& column : columns)
        width += column.width();
    return width;
}

/// Makes columns that always stay narrower where they do not fit: first their titles, then the first column's cells.
void fold_into(std::vector<ShownColumn>& columns, std::size_t width)
{
    constexpr std::size_t least = 16;
    if (columns.empty() || width_of_all(columns) <= width) return;
    for (ShownColumn& column : columns)
        column.title = folded(column.title.front(), std::max(column.cell_width(), least));
    const std::size_t all = width_of_all(columns), first = columns.front().width();
    if (all <= width) return;
    const std::size_t left = first - std::min(first, all - width);
    for (Lines& cell : columns.front().cells)
        cell = folded(cell.front(), std::max(left, least));
}

/// Parts that fit into the width, one below the other, each with the first column.
std::vector<std::vector<ShownColumn>> parts_of(const std::vector<ShownColumn>& columns, std::size_t width)
{
    std::vector<std::vector<ShownColumn>> parts;
    for (const ShownColumn& column : columns | std::views::drop(1)) {
        if (parts.empty() || width_of_all(parts.back()) + gap.size() + column.width() > width)
            parts.push_back({columns.front()});
        parts.back().push_back(column);
    }
    if (parts.empty()) parts.push_back(columns);
    return parts;
}

/// A line of the table, or the lines of its highest cell.
template <class Cells>
std::string lines_of(const std::vector<ShownColumn>& columns, const std::string& margin, const Cells& cells_of,
                     bool coloured = false)
{
    std::size_t height = 1;
    for (const ShownColumn& column : columns)
        height = std::max(height, cells_of(column).size());
    std::string result;
    for (std::size_t i = 0; i < height; ++i) {
        std::string line = margin;
        for (const ShownColumn& column : columns) {
            const Lines cell = cells_of(column);
            if (&column != &columns.front()) line.append(gap);
            line += padded(i < cell.size() ? cell[i] : "", column.width(), column.right, coloured && column.coloured);
        }
        result += without_trailing_blanks(std::move(line));
    }
    return result;
}

} // namespace

std::string cell_text(const Cell& cell, const Column& column)
{
    return std::visit(
        Overloaded{[](std::monostate) { return std::string("-"); }, [](const std::string& text) { return text; },
                   [](std::uint64_t value) { return with_commas(value); },
                   [&](double value) {
                       return std::isfinite(value) ? fmt::format("{:.{}f}", value, column.decimals) : std::string("-");
                   }},
        cell);
}

void Table::add(std::vector<Cell> cells)
{
    if (cells.size() != columns_.size())
        throw Error(ErrorKind::internal,
                    fmt::format("a table of {} columns was given a row of {} cells", columns_.size(), cells.size()));
    rows_.push_back(std::move(cells));
}

bool Table::has_cells(std::size_t column) const
{
    return std::ranges::any_of(rows_, [&](const auto& row) { return !is_empty(row[column]); });
}

bool Table::is_number(std::size_t column) const
{
    return std::ranges::none_of(rows_,
                                [&](const auto& row) { return std::holds_alternative<std::string>(row[column]); });
}

std::size_t Table::width_of(std::size_t column) const
{
    std::size_t width = std::max(display_width(columns_[column].title), display_width(columns_[column].unit));
    for (const auto& row : rows_)
        width = std::max(width, display_width(cell_text(row[column], columns_[column])));
    return width;
}

std::vector<std::size_t> Table::fitting(std::size_t indent, std::size_t width) const
{
    std::vector<std::size_t> wanted;
    for (std::size_t c = 0; c < columns_.size(); ++c)
        if (has_cells(c)) wanted.push_back(c);
    if (width == 0 || wanted.empty()) return wanted;
    std::ranges::stable_sort(wanted.begin() + 1, wanted.end(),
                             [&](std::size_t a, std::size_t b) { return columns_[a].rank < columns_[b].rank; });
    std::vector<std::size_t> kept = {wanted.front()};
    std::size_t length = indent + width_of(wanted.front());
    for (const std::size_t c : wanted) {
        const std::size_t longer = length + gap.size() + width_of(c);
        if (c == wanted.front() || (longer > width && columns_[c].rank > 0)) continue;
        length = longer;
        kept.push_back(c);
    }
    std::ranges::sort(kept);
    return kept;
}

std::vector<std::string> Table::dropped(std::size_t indent, std::size_t width) const
{
    const auto kept = fitting(indent, width);
    std::vector<std::string> titles;
    for (std::size_t c = 0; c < columns_.size(); ++c)
        if (has_cells(c) && std::ranges::find(kept, c) == kept.end()) titles.push_back(columns_[c].title);
    return titles;
}

Table Table::of_columns(const std::vector<std::size_t>& kept) const
{
    std::vector<Column> columns;
    for (const std::size_t c : kept)
        columns.push_back(columns_[c]);
    Table table(std::move(columns));
    for (const auto& row : rows_) {
        std::vector<Cell> cells;
        for (const std::size_t c : kept)
            cells.push_back(row[c]);
        table.add(std::move(cells));
    }
    table.headings_ = headings_;
    return table;
}

Table Table::with_columns(const std::vector<std::string>& keys) const
{
    std::vector<std::size_t> kept;
    bool has_any = false;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        const bool is_chosen = std::ranges::find(keys, columns_[c].key) != keys.end();
        if (c == 0 || is_chosen) kept.push_back(c);
        has_any = has_any || is_chosen;
    }
    return has_any ? of_columns(kept) : *this;
}

Table Table::without_empty_columns() const
{
    return of_columns(fitting(0, 0));
}

std::string Table::text(std::size_t indent, std::size_t width) const
{
    std::vector<ShownColumn> columns;
    for (const std::size_t c : fitting(indent, width)) {
        ShownColumn& shown = columns.emplace_back(ShownColumn{{columns_[c].title}, columns_[c].unit, {}, is_number(c)});
        shown.coloured = columns_[c].coloured;
        for (const auto& row : rows_)
            shown.cells.push_back({cell_text(row[c], columns_[c])});
    }
    const std::string margin(indent, ' ');
    const auto lines_with = [&](const std::vector<ShownColumn>& part) {
        std::string lines = lines_of(part, margin, [](const ShownColumn& shown) { return shown.title; });
        if (std::ranges::any_of(part, [](const ShownColumn& shown) { return !shown.unit.empty(); }))
            lines += lines_of(part, margin, [](const ShownColumn& shown) { return Lines{shown.unit}; });
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            const auto [first, last] = headings_.equal_range(r);
            for (auto heading = first; heading != last; ++heading)
                lines += without_trailing_blanks(margin + heading->second);
            lines += lines_of(
                part, margin, [r](const ShownColumn& shown) { return shown.cells[r]; }, true);
        }
        return lines;
    };
    if (width == 0) return lines_with(columns);
    const std::size_t within = width - std::min(width, indent);
    fold_into(columns, within);
    std::string result;
    for (const auto& part : parts_of(columns, within))
        result += (result.empty() ? "" : "\n") + lines_with(part);
    return result;
}

std::string Table::csv() const
{
    std::string result;
    for (std::size_t c = 0; c < columns_.size(); ++c)
        result.append(c ? "," : "").append(quoted(columns_[c].key));
    result += "\n";
    for (const auto& row : rows_) {
        for (std::size_t c = 0; c < row.size(); ++c)
            result.append(c ? "," : "").append(csv_cell(row[c]));
        result += "\n";
    }
    return result;
}

std::string Table::markdown() const
{
    std::string titles = "|", rule = "|";
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        const Column& column = columns_[c];
        titles += fmt::format(" {}{} |", column.title, column.unit.empty() ? "" : " (" + column.unit + ")");
        rule += is_number(c) ? "---:|" : "---|";
    }
    std::string result = titles + "\n" + rule + "\n";
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const auto [first, last] = headings_.equal_range(r);
        for (auto heading = first; heading != last; ++heading) {
            result += fmt::format("| **{}** |", in_markdown(heading->second));
            for (std::size_t c = 1; c < columns_.size(); ++c)
                result += " |";
            result += "\n";
        }
        result += "|";
        for (std::size_t c = 0; c < columns_.size(); ++c)
            result.append(" ").append(in_markdown(cell_text(rows_[r][c], columns_[c]))).append(" |");
        result += "\n";
    }
    return result;
}

} // namespace tetrace
