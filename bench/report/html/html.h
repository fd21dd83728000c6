#pragma once

#include "bench/terminal/table.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tetrace {

/// Attributes of an element, by name. Names are the program's own; values are always escaped.
using Attributes = std::vector<std::pair<std::string_view, std::string>>;

/// HTML markup, including SVG. Only text() and element() create it, so text from a result file is never read as markup.
class Html {
public:
    Html() = default;
    Html& operator+=(const Html& more)
    {
        markup_ += more.markup_;
        return *this;
    }
    [[nodiscard]] const std::string& str() const { return markup_; }
    [[nodiscard]] bool empty() const { return markup_.empty(); }

private:
    explicit Html(std::string markup) : markup_(std::move(markup)) {}
    std::string markup_;

    friend Html text(std::string_view plain);
    friend Html element(std::string_view name, const Attributes& attributes, const Html& content);
    friend Html style_sheet();
    friend Html whole_page(const Html& head, const Html& body);
};

[[nodiscard]] inline Html operator+(Html left, const Html& right)
{
    return left += right;
}

/// A plain text, escaped (see xml_text()).
[[nodiscard]] Html text(std::string_view plain);

/// <name attributes>content</name>; meta and img, which never have content, are not closed.
[[nodiscard]] Html element(std::string_view name, const Attributes& attributes, const Html& content = {});

/// An element of a class that contains only text; no class attribute where the class is empty.
[[nodiscard]] Html text_element(std::string_view name, std::string_view css_class, std::string_view plain);

/// The page's own style sheet, as a style element.
[[nodiscard]] Html style_sheet();

/// <!DOCTYPE html> and the html element.
[[nodiscard]] Html whole_page(const Html& head, const Html& body);

/// Bytes as base64 (RFC 4648, section 4, with padding).
[[nodiscard]] std::string base64(std::string_view bytes);

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
    /// Empty without rows. The table scrolls sideways by itself if the page is too narrow for it.
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
    Html content; ///< empty: the page leaves the section out
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
