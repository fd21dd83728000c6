#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tetrace {

/// A cell: empty (printed as a dash), text, a whole number or a real number.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

[[nodiscard]] inline bool is_empty(const Cell& cell)
{
    return std::holds_alternative<std::monostate>(cell);
}

/// A cell that is empty if the text is.
[[nodiscard]] inline Cell text_cell(const std::string& text)
{
    return text.empty() ? Cell() : Cell(text);
}

/// A cell that is empty without a value.
template <class T>
[[nodiscard]] Cell cell_of(const std::optional<T>& value)
{
    return value ? Cell(*value) : Cell();
}

/// A column. `key` names it in CSV and JSON and includes the unit (`build_s`); text and Markdown show title and unit.
struct Column {
    std::string key;
    std::string title;
    std::string unit = {};
    int decimals = 2;      ///< of real numbers, in text and Markdown; CSV keeps all digits
    bool coloured = false; ///< whether text() shows its words by in_colour()
    int rank = 1;          ///< the lower, the more important on a narrow terminal; 0: it is always there
};

/// A table that prints itself as aligned text, CSV or Markdown. Numbers are right-aligned, texts left-aligned.
class Table {
public:
    explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

    /// Throws Error{internal} if the number of cells differs from the number of columns.
    void add(std::vector<Cell> cells);
    /// A line of text above the rows that are added next; CSV does not have it.
    void add_heading(const std::string& text) { headings_.emplace(rows_.size(), text); }

    [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
    [[nodiscard]] const std::vector<std::vector<Cell>>& rows() const { return rows_; }

    /// Lines indented by `indent` blanks: titles, units where a column has one, rows. Columns with only empty cells are
    /// left out, and so are the dropped() ones. If those that are always there do not fit next to each other, the table
    /// is printed in parts, one below the other, each with the first column.
    [[nodiscard]] std::string text(std::size_t indent = 0, std::size_t width = 0) const;
    /// The titles of the columns that do not fit into lines of `width` columns (0: any length), in the table's order:
    /// the first column stays, those of rank 0, and of the others those that still fit, by rank, and among equal ones
    /// from the left.
    [[nodiscard]] std::vector<std::string> dropped(std::size_t indent, std::size_t width) const;
    /// The first column and those with these keys; the whole table where it has none of them.
    [[nodiscard]] Table with_columns(const std::vector<std::string>& keys) const;
    [[nodiscard]] Table without_empty_columns() const;
    /// RFC 4180, except that lines end in \n: keys, then rows; an empty cell is empty. A text that a spreadsheet would
    /// take for a formula has an apostrophe before it.
    [[nodiscard]] std::string csv() const;
    /// A GitHub table; the header shows each unit after its title, and a heading is a row in bold.
    [[nodiscard]] std::string markdown() const;

    /// Whether no cell of the column holds text.
    [[nodiscard]] bool is_number(std::size_t column) const;

private:
    [[nodiscard]] bool has_cells(std::size_t column) const;
    [[nodiscard]] std::size_t width_of(std::size_t column) const;
    /// The columns that fit, in their order.
    [[nodiscard]] std::vector<std::size_t> fitting(std::size_t indent, std::size_t width) const;
    [[nodiscard]] Table of_columns(const std::vector<std::size_t>& kept) const;

    std::vector<Column> columns_;
    std::vector<std::vector<Cell>> rows_;
    std::multimap<std::size_t, std::string> headings_; ///< by the row that they precede
};

/// A cell as text shows it; a dash where it is empty or a real number that is not finite.
[[nodiscard]] std::string cell_text(const Cell& cell, const Column& column);

} // namespace tetrace
