#include "bench/terminal/table.h"

#include "bench/terminal/colour.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

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
    // Spreadsheets would compute a cell that begins so, if it is no mere number; after an apostrophe they show it.
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

std::string Table::text(std::size_t indent) const
{
    const std::string margin(indent, ' ');
    std::string titles = margin, units = margin;
    std::vector<std::string> lines(rows_.size(), margin);
    bool any_unit = false;
    std::string gap;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        if (!has_cells(c)) continue;
        const Column& column = columns_[c];
        std::size_t width = std::max(display_width(column.title), display_width(column.unit));
        for (const auto& row : rows_)
            width = std::max(width, display_width(cell_text(row[c], column)));
        const bool right = is_number(c);
        titles += gap + padded(column.title, width, right);
        units += gap + padded(column.unit, width, right);
        any_unit = any_unit || !column.unit.empty();
        for (std::size_t r = 0; r < rows_.size(); ++r)
            lines[r] += gap + padded(cell_text(rows_[r][c], column), width, right, column.coloured);
        gap = "  ";
    }
    std::string result = without_trailing_blanks(titles);
    if (any_unit) result += without_trailing_blanks(units);
    for (std::size_t r = 0; r < lines.size(); ++r) {
        const auto [first, last] = headings_.equal_range(r);
        for (auto heading = first; heading != last; ++heading)
            result += without_trailing_blanks(margin + heading->second);
        result += without_trailing_blanks(lines[r]);
    }
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
    for (const auto& row : rows_) {
        result += "|";
        for (std::size_t c = 0; c < row.size(); ++c)
            result.append(" ").append(in_markdown(cell_text(row[c], columns_[c]))).append(" |");
        result += "\n";
    }
    return result;
}

} // namespace tetrace
