#include "bench/report/standalone.h"

#include "bench/report/html/html.h"
#include "bench/report/html/svg.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <sstream>

namespace tetrace {

namespace {

constexpr std::size_t max_name = 120;

/// What is between two texts, the first one after `from`; empty if they are not there.
std::string between(const std::string& text, const std::string& begin, const std::string& end, std::size_t from = 0)
{
    const std::size_t first = text.find(begin, from);
    if (first == std::string::npos) return {};
    const std::size_t start = first + begin.size(), last = text.find(end, start);
    return last == std::string::npos ? std::string() : text.substr(start, last - start);
}

/// A rule with the values of its variables, which the style sheet has in light colours first. series: that of --c.
std::string with_values(std::string rule, const std::string& sheet, std::size_t series = 0)
{
    for (std::size_t at = rule.find("var("); at != std::string::npos; at = rule.find("var(")) {
        const std::string name = between(rule, "var(", ")", at);
        const std::string value = between(sheet, (name == "--c" ? fmt::format("--s{}", series) : name) + ": ", ";");
        rule.replace(at, name.size() + 5, value);
    }
    return rule;
}

/// A rule of the page for its charts, in a chart alone; a rule for each series if the colour depends on it.
std::string rule_alone(const std::string& rule, const std::string& sheet)
{
    if (rule.find("var(--c)") == std::string::npos) return with_values(rule, sheet) + "\n";
    constexpr std::string_view any_chart = "svg";
    std::string rules;
    for (std::size_t series = 0; series < series_styles; ++series)
        rules +=
            fmt::format(".s{}{}\n", series,
                        with_values(rule.starts_with(any_chart) ? rule.substr(any_chart.size()) : rule, sheet, series));
    return rules;
}

/// The page's rules for charts are lines of their own.
std::string style_alone()
{
    const std::string sheet = style_sheet().str();
    std::istringstream lines(sheet);
    std::string style = "svg { font: 13px Arial, Helvetica, 'DejaVu Sans', sans-serif; }\n";
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("svg .") || line.starts_with("svg text") || line.starts_with(".d1 .line") ||
            line.starts_with(".d4 .line") || line.starts_with(".open "))
            style += rule_alone(line, sheet);
    return style;
}

/// Small letters and digits of a name that is escaped for XML, in words joined by dashes.
std::string slug(const std::string& escaped)
{
    std::string words;
    for (std::size_t i = 0; i < escaped.size() && words.size() < max_name; ++i) {
        const char c = escaped[i];
        if (c == '&') i = std::min(escaped.find(';', i), escaped.size() - 1);
        const bool is_kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
        if (is_kept)
            words += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!words.empty() && words.back() != '-')
            words += '-';
    }
    words.erase(words.find_last_not_of("-.") + 1);
    return words;
}

/// The definitions of the page's marks that a chart refers to.
std::string marks_for(const std::string& chart, const std::string& page)
{
    std::string marks;
    for (std::size_t at = page.find("<marker "); at != std::string::npos; at = page.find("<marker ", at + 1))
        if (chart.find("url(#" + between(page, "id=\"", "\"", at) + ")") != std::string::npos)
            marks += page.substr(at, page.find("</marker>", at) - at) + "</marker>";
    return marks.empty() ? marks : "<defs>" + marks + "</defs>";
}

/// The section's name is not repeated.
std::string name_of_chart(const std::string& section, const std::string& label)
{
    const std::string name = slug(label);
    return name.starts_with(section) ? name : slug(section + "-" + label);
}

std::string section_before(const std::string& page, std::size_t chart)
{
    const std::size_t section = page.rfind("<section id=\"", chart);
    return section == std::string::npos ? "chart" : between(page, "id=\"", "\"", section);
}

} // namespace

std::vector<StandaloneChart> standalone_charts(const std::string& page)
{
    const std::string opening = "<svg viewBox=", style = "<style>" + style_alone() + "</style>";
    std::vector<StandaloneChart> charts;
    std::map<std::string, int> names;
    for (std::size_t at = page.find(opening); at != std::string::npos; at = page.find(opening, at + 1)) {
        const std::string chart = page.substr(at, page.find("</svg>", at) + 6 - at);
        const std::string name = name_of_chart(section_before(page, at), between(chart, "aria-label=\"", "\""));
        const int number = ++names[name];
        const std::size_t content = chart.find('>') + 1;
        charts.push_back({name + (number > 1 ? fmt::format("-{}", number) : "") + ".svg",
                          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"" +
                              chart.substr(4, content - 4) + style + marks_for(chart, page) + chart.substr(content) +
                              "\n"});
    }
    return charts;
}

} // namespace tetrace
