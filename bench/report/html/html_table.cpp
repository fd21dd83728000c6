#include "bench/report/html/html_table.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace tetrace {

namespace {

struct BadgeLook {
    std::string_view word, css_class, sign;
};

constexpr BadgeLook neutral = {"", "neutral", "–"};

/// By a word's beginning: a cell may read "wrong: 3 rays".
constexpr std::array badge_looks = {
    BadgeLook{"holds", "good", "✓"},
    BadgeLook{"does not hold", "bad", "✗"},
    BadgeLook{"not testable", "neutral", "–"},
    BadgeLook{"bit-exact", "good", "✓"},
    BadgeLook{"reference", "good", "●"},
    BadgeLook{"within", "fair", "≈"},
    BadgeLook{"not exact", "fair", "!"},
    BadgeLook{"ok", "good", "✓"},
    BadgeLook{"flawed", "fair", "!"},
    BadgeLook{"wrong", "bad", "✗"},
    BadgeLook{"error", "bad", "✗"},
};

constexpr std::ptrdiff_t narrow_columns = 4; // that fit the screen of a phone

const BadgeLook& look_of(std::string_view word)
{
    const auto found = std::ranges::find_if(
        badge_looks, [&](const BadgeLook& look) { return word.substr(0, look.word.size()) == look.word; });
    return found == badge_looks.end() ? neutral : *found;
}

} // namespace

void HtmlTable::add(std::vector<Html> cells)
{
    if (cells.size() != columns_.size())
        throw Error(ErrorKind::internal,
                    fmt::format("HtmlTable: {} cells for {} columns", cells.size(), columns_.size()));
    rows_.push_back(std::move(cells));
}

Html HtmlTable::row_html(std::string_view tag, const std::vector<Html>& cells, const std::vector<bool>& used) const
{
    Html row;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (!used[c]) continue;
        row += element(tag, columns_[c].number ? Attributes{{"class", "n"}} : Attributes{}, cells[c]);
    }
    return element("tr", {}, row);
}

Html HtmlTable::html() const
{
    if (rows_.empty()) return {};
    std::vector<bool> used;
    std::vector<Html> titles;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        used.push_back(std::ranges::any_of(rows_, [&](const auto& row) { return !row[c].empty(); }));
        const Html unit =
            columns_[c].unit.empty() ? Html() : text(" ") + text_element("span", "unit", columns_[c].unit);
        titles.push_back(text(columns_[c].title) + unit);
    }
    Html body;
    for (const auto& row : rows_)
        body += row_html("td", row, used);
    const Html table =
        element("table", {}, element("thead", {}, row_html("th", titles, used)) + element("tbody", {}, body));
    const bool is_wide = std::ranges::count(used, true) > narrow_columns;
    return element("div", {{"class", is_wide ? "scroll wide" : "scroll"}, {"tabindex", "0"}}, table);
}

HtmlTable html_table(const Table& table)
{
    std::vector<HtmlColumn> columns;
    for (std::size_t c = 0; c < table.columns().size(); ++c)
        columns.push_back({table.columns()[c].title, table.columns()[c].unit, table.is_number(c)});
    HtmlTable result(std::move(columns));
    for (const auto& row : table.rows()) {
        std::vector<Html> cells;
        for (std::size_t c = 0; c < row.size(); ++c)
            cells.push_back(is_empty(row[c]) ? Html() : text(cell_text(row[c], table.columns()[c])));
        result.add(std::move(cells));
    }
    return result;
}

Html paragraph(std::string_view plain)
{
    return text_element("p", "", plain);
}

Html note(std::string_view plain)
{
    return text_element("p", "note", plain);
}

Html heading(std::string_view plain)
{
    return text_element("h3", "", plain);
}

Html figure(std::string_view title, const Html& content, std::string_view caption)
{
    Html parts;
    if (!title.empty()) parts += text_element("h4", "", title);
    parts += content;
    if (!caption.empty()) parts += text_element("figcaption", "", caption);
    return element("figure", {}, parts);
}

Html side_by_side(const Html& content)
{
    return element("div", {{"class", "pair"}}, content);
}

Html badge(std::string_view word)
{
    const BadgeLook& look = look_of(word);
    return element("span", {{"class", fmt::format("badge {}", look.css_class)}},
                   text_element("span", "sign", look.sign) + text(" ") + text(word));
}

} // namespace tetrace
