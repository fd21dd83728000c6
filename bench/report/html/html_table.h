#pragma once

#include "bench/report/html/html.h"
#include "bench/terminal/table.h"

#include <vector>

namespace tetrace {

/// A column of a table on the page; numbers are right-aligned.
struct HtmlColumn {
    std::string title, unit = {};
    bool number = false;
};

/// A table on the page; columns with only empty cells are left out.
class HtmlTable {
public:
    explicit HtmlTable(std::vector<HtmlColumn> columns) : columns_(std::move(columns)) {}

    /// Throws Error{internal} if the number of cells differs from the number of columns.
    void add(std::vector<Html> cells);
    [[nodiscard]] bool empty() const { return rows_.empty(); }
    /// Empty if there are no rows. The table scrolls sideways by itself if the page is too narrow for it.
    [[nodiscard]] Html html() const;

private:
    [[nodiscard]] Html row_html(std::string_view tag, const std::vector<Html>& cells,
                                const std::vector<bool>& used) const;

    std::vector<HtmlColumn> columns_;
    std::vector<std::vector<Html>> rows_;
};

/// The same table on the page.
[[nodiscard]] HtmlTable html_table(const Table& table);

/// A part of the page: anchor, heading, content.
struct Section {
    std::string id, title;
    Html content;
    bool is_empty = false; ///< its content only says that there are none
};

[[nodiscard]] Html paragraph(std::string_view plain);
/// A note in small letters.
[[nodiscard]] Html note(std::string_view plain);
[[nodiscard]] Html heading(std::string_view plain);
/// A picture or drawing with its caption under a title; both may be empty.
[[nodiscard]] Html figure(std::string_view title, const Html& content, std::string_view caption);
/// Elements side by side if the page is wide enough.
[[nodiscard]] Html side_by_side(const Html& content);

/// A status, verdict or conformity with a sign before it, so that colour is not the only cue.
[[nodiscard]] Html badge(std::string_view word);

} // namespace tetrace
