#include "bench/report/charts/axis.h"
#include "bench/report/charts/line_chart.h"
#include "bench/report/png.h"
#include "bench/report/sections.h"

#include <fmt/format.h>
#include <optional>

namespace tetrace {

namespace {

std::string title_with_source(const ResultValue& part)
{
    const std::string source = part.text_at("source");
    return part.at("title").text() + (source.empty() ? "" : " · " + source);
}

/// With the column's decimals where the result gives them.
using Decimals = std::optional<int>;

std::string number_text(const ResultValue& value, Decimals decimals)
{
    return decimals ? fixed_number(value.number(), *decimals) : short_number(value.number());
}

/// A measured value with the paper's value.
Html value_with_paper(const ResultValue& cell, Decimals decimals)
{
    Html content = cell.find("text") ? text(cell.at("text").text()) : Html();
    if (const auto value = cell.find("value"); value && content.empty()) content = text(number_text(*value, decimals));
    const auto low = cell.find("low"), high = cell.find("high");
    if (low && high)
        content += text_element("small", "",
                                fmt::format("{} to {}", number_text(*low, decimals), number_text(*high, decimals)));
    if (const auto paper = cell.find("paper")) {
        const auto ratio = cell.find("ratio");
        content += text_element("small", "paper",
                                fmt::format("paper {}{}", number_text(*paper, decimals),
                                            ratio ? ", × " + short_number(ratio->number()) : ""));
    }
    return content;
}

Html cell_html(const ResultValue& cell, Decimals decimals)
{
    if (cell.json().is_object()) return value_with_paper(cell, decimals);
    return text(cell.json().is_string() ? cell.text() : number_text(cell, decimals));
}

Decimals decimals_of(const ResultValue& column)
{
    const auto decimals = column.find("decimals");
    if (!decimals) return std::nullopt;
    if (decimals->count() > 15) decimals->reject("is not a number of decimals from 0 to 15");
    return static_cast<int>(decimals->count());
}

/// Whether the column holds only numbers.
bool is_number_column(const ResultValue& rows, const std::string& key)
{
    for (const ResultValue& row : rows.items())
        if (const auto cell = row.find(key); cell && cell->json().is_string()) return false;
    return true;
}

Html table_of(const ResultValue& part)
{
    const ResultValue rows = part.at("rows");
    std::vector<HtmlColumn> columns;
    std::vector<std::string> keys;
    std::vector<Decimals> decimals;
    for (const ResultValue& column : part.at("columns").items()) {
        keys.push_back(column.at("key").text());
        decimals.push_back(decimals_of(column));
        columns.push_back({column.at("title").text(), column.text_at("unit"), is_number_column(rows, keys.back())});
    }
    HtmlTable table(columns);
    for (const ResultValue& row : rows.items()) {
        std::vector<Html> cells;
        for (std::size_t c = 0; c < keys.size(); ++c) {
            const auto cell = row.find(keys[c]);
            cells.push_back(cell ? cell_html(*cell, decimals[c]) : Html());
        }
        table.add(std::move(cells));
    }
    return table.empty() ? paragraph("This table is empty.") : table.html();
}

Html claims_of(const ResultValue& part)
{
    const auto claims = part.find("claims");
    HtmlTable table({{"verdict"}, {"claim"}, {"evidence"}});
    if (claims)
        for (const ResultValue& claim : claims->items())
            table.add(
                {badge(claim.at("verdict").line()), text(claim.at("text").text()), text(claim.text_at("evidence"))});
    return table.html();
}

Html notes_of(const ResultValue& part)
{
    Html notes;
    if (const auto list = part.find("notes"))
        for (const ResultValue& sentence : list->items())
            notes += note(sentence.text());
    return notes;
}

/// "time, ms".
std::string axis_title(const ResultValue& axis)
{
    const std::string unit = axis.text_at("unit");
    return axis.at("title").text() + (unit.empty() ? "" : ", " + unit);
}

bool is_logarithmic(const ResultValue& axis)
{
    const auto scale = axis.find("scale");
    if (!scale || scale->text() == "linear") return false;
    if (scale->text() != "logarithmic") scale->reject("is not a scale: use linear or logarithmic");
    return true;
}

double coordinate(const ResultValue& value, bool logarithmic)
{
    if (logarithmic && !(value.number() >= 1e-18)) value.reject("is below 1e-18 on a logarithmic axis");
    if (value.number() < -1e18 || value.number() > 1e18) value.reject("is outside ±1e18");
    return value.number();
}

Series series_of(const ResultValue& value, const LineChart& chart)
{
    Series series{value.at("name").text(), {}};
    for (const ResultValue& point : value.at("points").items()) {
        const auto pair = point.items();
        if (pair.size() != 2) point.reject("is not a point of two numbers");
        series.points.emplace_back(coordinate(pair[0], chart.x_logarithmic), coordinate(pair[1], chart.y_logarithmic));
    }
    return series;
}

Html chart_of(const ResultValue& part)
{
    LineChart chart{part.at("title").text(),      axis_title(part.at("x")),    axis_title(part.at("y")), {},
                    is_logarithmic(part.at("x")), is_logarithmic(part.at("y"))};
    std::size_t points = 0;
    for (const ResultValue& series : part.at("series").items()) {
        chart.series.push_back(series_of(series, chart));
        points += chart.series.back().points.size();
    }
    return points == 0 ? paragraph("This figure is empty.") : figure("", draw(chart), "");
}

Html pictures_of(const ResultValue& part, const std::filesystem::path& result)
{
    Html pictures;
    if (const auto names = part.find("pictures"))
        for (const ResultValue& name : names->items())
            pictures += named_picture(result.parent_path(), name.line());
    return pictures.empty() ? pictures : side_by_side(pictures);
}

Html part_html(const ResultValue& part, const Html& content)
{
    return element("article", {}, heading(title_with_source(part)) + content + claims_of(part) + notes_of(part));
}

Html parts_of(const ResultFile& file)
{
    Html parts;
    if (const auto tables = file.section().find("tables"))
        for (const ResultValue& part : tables->items())
            parts += part_html(part, table_of(part));
    if (const auto figures = file.section().find("figures"))
        for (const ResultValue& part : figures->items())
            parts += part_html(part, chart_of(part) + pictures_of(part, file.path));
    return parts;
}

} // namespace

Section paper_section(const ReportInput& input)
{
    Section section{"paper", "The paper's tables and figures", {}};
    for (const ResultFile& file : input.files)
        section.content += parts_of(file);
    return section;
}

} // namespace tetrace
