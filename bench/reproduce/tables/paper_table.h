#pragma once

#include "bench/reproduce/claims.h"
#include "bench/rows/row_run.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tetrace {

/// One of our numbers, and the paper's where it is known.
struct Quantity {
    Estimate ours;
    std::optional<double> paper;
    bool is_compared = true; ///< whether the two are of things so alike that their ratio means something

    /// Ours over the paper's; empty if the paper's is unknown or 0, or they are not compared.
    [[nodiscard]] std::optional<double> ratio() const;
};
/// A cell: empty, a text or a number.
using PaperCell = std::variant<std::monostate, std::string, Quantity>;

[[nodiscard]] PaperCell exact_cell(double value, std::optional<double> paper = {});
/// An exact number; an empty cell where there is none.
[[nodiscard]] PaperCell known_number(std::optional<double> value);
/// An empty cell where the text is empty.
[[nodiscard]] PaperCell known_text(std::string text);
/// The labels that come first, then method, layout, device and its type.
[[nodiscard]] std::vector<PaperCell> label_cells(std::vector<PaperCell> first, const RowRecord& row);
/// The columns of label_cells() for a row's scene and build, then the others.
[[nodiscard]] std::vector<Column> with_labels(const std::vector<Column>& others);

/// A table of the paper, measured again.
struct PaperTable {
    std::string id, title, source;
    std::vector<Column> columns;
    std::vector<std::string> notes;
    std::vector<Claim> claims = {};
    std::vector<std::vector<PaperCell>> rows = {}; ///< a cell a column
};

/// A figure of the paper, measured again.
struct PaperFigure {
    struct Axis {
        std::string title, unit;
        bool logarithmic = false;
    };
    struct Series {
        std::string name;
        std::vector<std::pair<double, double>> points;
    };
    std::string id, title, source;
    Axis x, y;
    std::vector<std::string> notes;
    std::vector<Series> series = {};
    std::vector<Claim> claims = {};
    std::vector<std::string> pictures = {}; ///< file names, relative to the result's file
};

/// As results/README.md describes them. Numbers that are not finite are left out.
[[nodiscard]] nlohmann::json table_json(const PaperTable& table);
[[nodiscard]] nlohmann::json figure_json(const PaperFigure& figure);

/// The rows. Numbers have their 95 % intervals, if there are any; the paper's numbers and the ratios have columns of
/// their own.
[[nodiscard]] Table with_paper_columns(const PaperTable& table);

/// Everything that tables and figures say, one fact a row. Each row names its table and row, and holds one of: a number
/// with its interval, the paper's number and the ratio; a text, such as a status; a point (x next to the value); a
/// claim with its verdict and evidence; a note.
[[nodiscard]] Table tidy_table(const std::vector<PaperTable>& tables, const std::vector<PaperFigure>& figures);

/// Title, rows, claims and notes, for people.
[[nodiscard]] Sheet table_sheet(const PaperTable& table);
[[nodiscard]] std::string table_markdown(const PaperTable& table);
[[nodiscard]] Sheet figure_sheet(const PaperFigure& figure);
[[nodiscard]] std::string figure_markdown(const PaperFigure& figure);

} // namespace tetrace
