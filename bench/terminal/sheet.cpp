#include "bench/terminal/sheet.h"

#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>

namespace tetrace {

namespace {

constexpr std::size_t prose_width = 110, min_width = 40, label_width = 10;

/// Each line unchanged, or wrapped after its own indent if the terminal is narrower.
std::string fitted(const std::string& lines, std::size_t width)
{
    std::istringstream input(lines);
    std::string text;
    for (std::string line; std::getline(input, line);) {
        const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
        const bool fits = width == 0 || display_width(line) <= width || indent + 20 > width;
        text += fits ? line + "\n" : wrapped(line, width, indent);
    }
    return text;
}

/// Markdown shows the text's own characters.
std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        if (c == '<' || c == '*' || c == '_' || c == '`') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

std::string without_last_newlines(std::string text)
{
    text.erase(text.find_last_not_of('\n') + 1);
    return text;
}

/// Which columns a terminal is too narrow for; empty if none.
std::string left_out(const std::vector<std::string>& titles, std::size_t indent, std::size_t width)
{
    if (titles.empty()) return {};
    return wrapped(fmt::format("Left out in {} columns: {}.", width, fmt::join(titles, ", ")), width, indent);
}

} // namespace

std::vector<std::string> Sheet::column_keys() const
{
    std::vector<std::string> keys;
    for (const auto& part : parts_)
        if (const auto* placed = std::get_if<Placed>(&part))
            for (const Column& column : placed->table.columns())
                if (std::ranges::find(keys, column.key) == keys.end()) keys.push_back(column.key);
    return keys;
}

std::string Sheet::text_of(const Words& words, std::size_t width)
{
    const std::size_t filled = width == 0 ? prose_width : std::min(width, prose_width);
    switch (words.kind) {
    case Kind::heading:
    case Kind::line:
    case Kind::verbatim: return fitted(words.text, width);
    case Kind::prose: return wrapped(words.text, filled, words.indent);
    case Kind::labelled:
        return fmt::format("{:<{}}", words.label, label_width) +
               wrapped(words.text, filled, label_width).substr(label_width);
    case Kind::gap: return "\n";
    }
    return {};
}

std::string Sheet::text(const SheetStyle& style) const
{
    const std::size_t width = style.width == 0 ? 0 : std::max(style.width, min_width);
    std::string text;
    for (const auto& part : parts_) {
        if (const auto* words = std::get_if<Words>(&part)) {
            text += text_of(*words, width);
            continue;
        }
        const auto& [whole, indent] = std::get<Placed>(part);
        const Table chosen = whole.with_columns(style.columns);
        const std::size_t limit = style.columns.empty() ? width : 0;
        text += chosen.text(indent, limit) + left_out(chosen.dropped(indent, limit), indent, width);
    }
    return text;
}

std::string Sheet::markdown_of(const Words& words)
{
    switch (words.kind) {
    case Kind::heading: return "### " + escaped(without_last_newlines(words.text)) + "\n";
    case Kind::line:
    case Kind::prose: return escaped(without_last_newlines(words.text)) + "\n";
    case Kind::verbatim: return "```\n" + without_last_newlines(words.text) + "\n```\n";
    case Kind::labelled: return fmt::format("- **{}**: {}\n", words.label, escaped(words.text));
    case Kind::gap: return {};
    }
    return {};
}

std::string Sheet::markdown(const SheetStyle& style) const
{
    std::string text;
    bool in_list = false;
    for (const auto& part : parts_) {
        const auto* words = std::get_if<Words>(&part);
        const std::string block =
            words != nullptr
                ? markdown_of(*words)
                : std::get<Placed>(part).table.with_columns(style.columns).without_empty_columns().markdown();
        if (block.empty()) continue;
        const bool is_item = words != nullptr && words->kind == Kind::labelled;
        if (!text.empty() && !(in_list && is_item)) text += "\n";
        in_list = is_item;
        text += block;
    }
    return text;
}

} // namespace tetrace
