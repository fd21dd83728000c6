#include "bench/report/html/html.h"

#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tetrace {

Html text(std::string_view plain)
{
    return Html(xml_text(std::string(plain)));
}

Html element(std::string_view name, const Attributes& attributes, const Html& content)
{
    std::string markup("<");
    markup += name;
    for (const auto& [key, value] : attributes)
        markup.append(" ").append(key).append("=\"").append(xml_text(value)).append("\"");
    markup += ">";
    if (name == "meta" || name == "img") return Html(std::move(markup));
    return Html(markup.append(content.str()).append("</").append(name).append(">"));
}

Html text_element(std::string_view name, std::string_view css_class, std::string_view plain)
{
    if (css_class.empty()) return element(name, {}, text(plain));
    return element(name, {{"class", std::string(css_class)}}, text(plain));
}

Html whole_page(const Html& head, const Html& body)
{
    return Html("<!DOCTYPE html>\n" +
                element("html", {{"lang", "en"}}, element("head", {}, head) + element("body", {}, body)).str() + "\n");
}

std::string base64(std::string_view bytes)
{
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string encoded;
    encoded.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto octet = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
        const unsigned group = octet(i) << 16 | octet(i + 1) << 8 | octet(i + 2);
        for (unsigned k = 0; k < 4; ++k)
            encoded += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return encoded;
}

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
    BadgeLook{"FASTER", "good", "✓"},
    BadgeLook{"SLOWER", "bad", "✗"},
    BadgeLook{"NOISY", "fair", "!"},
    BadgeLook{"FAILED", "bad", "✗"},
    BadgeLook{"MISSING", "bad", "✗"},
    BadgeLook{"known", "fair", "!"},
    BadgeLook{"unexpected", "bad", "✗"},
    BadgeLook{"new failure", "bad", "✗"},
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

namespace {

// Series have the colours of Okabe and Ito, "Color Universal Design" (2008). Grey replaces black; yellow is left out
// because it is hard to see on white.
const char* const style = R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --raised: #f6f7f8; --ink: #1b1f23; --muted: #5c646c; --rule: #dfe3e6; --grid: #e6e9ec;
  --link: #0b5cad; --good: #00694c; --good-back: #e2f3ec; --bad: #a33a00; --bad-back: #fbe9df;
  --fair: #7a5600; --fair-back: #fbf1d6; --neutral: #5c646c; --neutral-back: #eceef0;
  --s0: #0072b2; --s1: #6b7278; --s2: #e69f00; --s3: #d55e00; --s4: #009e73; --s5: #56b4e9; --s6: #cc79a7;
  --shade: #00000030;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171a; --raised: #1c2024; --ink: #e6e8ea; --muted: #9aa3ab; --rule: #333a40; --grid: #293036;
    --link: #7cb8f2; --good: #6fd3b0; --good-back: #12342a; --bad: #ff9d66; --bad-back: #43210e;
    --fair: #f0c75e; --fair-back: #3a2f10; --neutral: #a7b0b8; --neutral-back: #2a3036;
    --s0: #3f9fdc; --s1: #a9b1b8; --s2: #e69f00; --s3: #ef7b29; --s4: #19b98b; --s5: #7cc8f2; --s6: #d993ba;
    --shade: #ffffff40;
  }
}
@media print {
  :root {
    --paper: #ffffff; --raised: #ffffff; --ink: #000000; --muted: #444444; --rule: #bbbbbb; --grid: #dddddd;
    --link: #000000; --good: #00694c; --good-back: #ffffff; --bad: #a33a00; --bad-back: #ffffff;
    --fair: #7a5600; --fair-back: #ffffff; --neutral: #444444; --neutral-back: #ffffff;
    --s0: #0072b2; --s1: #6b7278; --s2: #e69f00; --s3: #d55e00; --s4: #009e73; --s5: #56b4e9; --s6: #cc79a7;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 72rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", Arial, sans-serif;
}
h1, h2, h3, h4 { line-height: 1.25; text-wrap: balance; }
h1 { margin: 0; font-size: 1.9rem; letter-spacing: -0.01em; }
h2 { margin: 3rem 0 0.75rem; padding-top: 0.9rem; border-top: 2px solid var(--ink); font-size: 1.4rem; }
h3 { margin: 1.75rem 0 0.5rem; font-size: 1.05rem; }
h4 { margin: 0 0 0.4rem; font-size: 0.9rem; font-weight: 600; }
p { margin: 0.5rem 0; max-width: 46rem; }
a { color: var(--link); }
code { font: 0.9em ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
.note, figcaption { color: var(--muted); font-size: 0.85rem; }
figcaption { margin-top: 0.35rem; }
.trust, .verdict { max-width: 60rem; }
.trust.fair { padding: 0.4rem 0.7rem; border-radius: 0.3rem; }
ul { padding-left: 1.2rem; }
ul.missing { font-size: 0.85rem; max-width: 60rem; }
ul.plain, ul.summary { margin: 0; padding: 0; list-style: none; }
ul.summary { display: flex; flex-wrap: wrap; gap: 0.4rem 0.6rem; margin: 0.75rem 0 1rem; }
ul.summary li { padding: 0.2rem 0.7rem; border-radius: 1rem; background: var(--neutral-back); font-size: 0.9rem; }
nav { display: flex; flex-wrap: wrap; gap: 0.25rem 1.1rem; font-size: 0.9rem; }
.scroll {
  overflow-x: auto; margin: 0.5rem 0 0.75rem;
  background: linear-gradient(to right, var(--paper) 30%, transparent) left / 2.5rem 100%,
    linear-gradient(to left, var(--paper) 30%, transparent) right / 2.5rem 100%,
    linear-gradient(to right, var(--shade), transparent) left / 0.9rem 100%,
    linear-gradient(to left, var(--shade), transparent) right / 0.9rem 100%;
  background-repeat: no-repeat; background-attachment: local, local, scroll, scroll;
}
table { border-collapse: collapse; font-size: 0.85rem; line-height: 1.35; font-variant-numeric: tabular-nums; }
th, td { padding: 0.32rem 0.7rem 0.32rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--rule); }
th { vertical-align: bottom; font-weight: 600; white-space: nowrap; }
th .unit { color: var(--muted); font-weight: 400; }
td { min-width: 2rem; max-width: 24rem; }
th.n, td.n { text-align: right; white-space: nowrap; }
th + th, td + td { padding-left: 0.4rem; }
td small { display: block; color: var(--muted); font-size: 0.8em; }
.badge { padding: 0.08rem 0.45rem; border-radius: 0.3rem; white-space: nowrap; }
.badge .sign { display: inline-block; min-width: 0.9em; text-align: center; }
.good { color: var(--good); background: var(--good-back); }
.bad { color: var(--bad); background: var(--bad-back); }
.fair { color: var(--fair); background: var(--fair-back); }
.neutral { color: var(--neutral); background: var(--neutral-back); }
.machines th { max-width: 10rem; white-space: normal; }
td code, td .date { white-space: nowrap; }
.type.emulated { font-style: italic; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1.5rem 2.5rem; }
figure { margin: 0.75rem 0; min-width: 0; max-width: 33rem; }
figure img { display: block; max-width: 100%; height: auto; border-radius: 0.25rem; }
article { margin-bottom: 2rem; }
#answer h4 { font-size: 1.05rem; text-wrap: pretty; }
svg { display: block; width: 100%; height: auto; overflow: visible; font-size: 13px; font-variant-numeric: tabular-nums; }
svg text { fill: var(--ink); white-space: pre; }
svg .small { fill: var(--muted); font-size: 11.5px; }
svg .end { text-anchor: end; }
svg .middle { text-anchor: middle; }
svg .value, svg .label { paint-order: stroke; stroke: var(--paper); stroke-width: 3px; stroke-linejoin: round; }
svg .value { font-weight: 500; }
svg .grid { stroke: var(--grid); }
svg .axis { stroke: var(--muted); }
svg .reference { stroke: var(--ink); stroke-width: 1.2; }
svg .whisker { stroke: var(--ink); stroke-width: 1.3; }
svg .sample { stroke: var(--ink); stroke-opacity: 0.45; }
svg .leader { fill: none; stroke: var(--muted); stroke-opacity: 0.45; stroke-width: 0.8; }
svg .roof { stroke: var(--ink); stroke-width: 1.8; }
.s0 { --c: var(--s0); } .s1 { --c: var(--s1); } .s2 { --c: var(--s2); } .s3 { --c: var(--s3); }
.s4 { --c: var(--s4); } .s5 { --c: var(--s5); } .s6 { --c: var(--s6); }
svg .bar { fill: var(--c); fill-opacity: 0.6; }
svg .interval { stroke: var(--c); stroke-width: 2.2; }
svg .solid { fill: var(--c); stroke: var(--paper); stroke-width: 0.8; }
svg .hollow { fill: var(--paper); stroke: var(--c); stroke-width: 1.8; }
svg .cloud { fill: var(--c); fill-opacity: 0.35; }
svg .line { fill: none; stroke: var(--c); stroke-width: 1.8; stroke-linejoin: round; }
.d1 .line { stroke-dasharray: 6 3; } .d2 .line { stroke-dasharray: 2 3; } .d3 .line { stroke-dasharray: 9 3 2 3; }
.d4 .line { stroke-dasharray: 12 4; } .d5 .line { stroke-dasharray: 4 2; } .d6 .line { stroke-dasharray: 1 2; }
.open .solid { fill: var(--paper); stroke: var(--c); stroke-width: 1.6; }
.open .cloud { fill: none; stroke: var(--c); stroke-opacity: 0.5; }
svg .carrier { fill: none; stroke: none; }
svg.definitions { position: absolute; width: 0; }
.mark:hover .bar { fill-opacity: 0.85; }
@media (max-width: 40rem) {
  table { width: max-content; }
  .wide::before { content: "wider than the screen: scroll →"; display: inline-block; position: sticky; left: 0; color: var(--muted); font-size: 0.8rem; }
  td { max-width: 15rem; }
  body { padding: 1.25rem 1rem 3rem; }
  h1 { font-size: 1.6rem; }
}
@media print {
  body { padding: 0; max-width: none; font-size: 11pt; }
  nav { display: none; }
  .scroll { overflow: visible; background: none; }
  table { font-size: 8pt; }
  figure, tr, h2, h3, h4 { break-inside: avoid; }
  h2, h3, h4 { break-after: avoid; }
}
)css";

} // namespace

Html style_sheet()
{
    return Html("<style>" + std::string(style) + "</style>");
}

} // namespace tetrace
