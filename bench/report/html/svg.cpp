#include "bench/report/html/svg.h"

#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

std::string pixels(double value)
{
    return fmt::format("{:.1f}", value);
}

/// Widths in DejaVu Sans, in 1/1000 of the font size; characters that are not ASCII count as wide as digits.
double character_width(char c)
{
    static constexpr std::string_view narrow = "iljI.,:;'|!", slim = "frt()[]{}/\\-\" ", wide = "mwMW%@";
    if (narrow.find(c) != std::string_view::npos) return 0.32;
    if (slim.find(c) != std::string_view::npos) return 0.40;
    if (wide.find(c) != std::string_view::npos) return 0.98;
    return c >= 'A' && c <= 'Z' ? 0.72 : 0.625;
}

/// Every series has another pair of colour and shape, and from series_marks / 2 on the shape is open.
std::size_t shape_of(std::size_t series)
{
    return (series + series / series_styles) % series_styles;
}

/// What a shape draws at the path's current point.
const char* shape_path(std::size_t series)
{
    // circle, square, triangle, diamond, inverted triangle, plus, cross
    static constexpr const char* shapes[] = {
        "m-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z",
        "m-4 -4h8v8h-8z",
        "m0 -5l5 8.5h-10z",
        "m0 -5.5l5.5 5.5l-5.5 5.5l-5.5 -5.5z",
        "m0 5l5 -8.5h-10z",
        "m-1.5 -5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5z",
        "m-4.6 -2.5l2.1 -2.1l2.5 2.5l2.5 -2.5l2.1 2.1l-2.5 2.5l2.5 2.5l-2.1 2.1l-2.5 "
        "-2.5l-2.5 2.5l-2.1 -2.1l2.5 -2.5z"};
    static_assert(std::size(shapes) == series_styles);
    return shapes[shape_of(series)];
}

/// A path that is not seen itself, with a mark at each of its points.
Html marked_path(const std::string& commands, const std::string& mark)
{
    const std::string reference = "url(#" + mark + ")";
    return element("path", {{"class", "carrier"},
                            {"marker-start", reference},
                            {"marker-mid", reference},
                            {"marker-end", reference},
                            {"d", commands}});
}

std::string cloud_mark(std::size_t series)
{
    return fmt::format("cloud{}", series % series_marks);
}

constexpr const char* sample_mark = "sample";

Html mark_definition(const std::string& id, const std::string& css_class, const Html& shape)
{
    return element("marker",
                   {{"id", id},
                    {"class", css_class},
                    {"markerUnits", "userSpaceOnUse"},
                    {"markerWidth", "12"},
                    {"markerHeight", "12"},
                    {"overflow", "visible"}},
                   shape);
}

bool refers_to(const Html& markup, const std::string& mark)
{
    return markup.str().find("url(#" + mark + ")") != std::string::npos;
}

bool continues_character(char c)
{
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

} // namespace

std::string series_class(std::size_t series)
{
    return fmt::format("s{} d{}{}", series % series_styles, shape_of(series),
                       series % series_marks < series_marks / 2 ? "" : " open");
}

Html svg_drawing(double height, const std::string& label, const Html& content)
{
    return element("svg",
                   {{"viewBox", fmt::format("0 0 {} {}", pixels(chart_width), pixels(height))},
                    {"width", pixels(chart_width)},
                    {"height", pixels(height)},
                    {"role", "img"},
                    {"aria-label", label}},
                   content);
}

Html svg_line(double x1, double y1, double x2, double y2, std::string_view css_class)
{
    return element("line", {{"class", std::string(css_class)},
                            {"x1", pixels(x1)},
                            {"y1", pixels(y1)},
                            {"x2", pixels(x2)},
                            {"y2", pixels(y2)}});
}

Html svg_rectangle(double x, double y, double width, double height, std::string_view css_class)
{
    return element("rect", {{"class", std::string(css_class)},
                            {"x", pixels(x)},
                            {"y", pixels(y)},
                            {"width", pixels(width)},
                            {"height", pixels(height)}});
}

Html svg_path(const std::string& commands, std::string_view css_class)
{
    return element("path", {{"class", std::string(css_class)}, {"d", commands}});
}

Html svg_text(double x, double y, std::string_view css_class, std::string_view plain)
{
    return element("text", {{"class", std::string(css_class)}, {"x", pixels(x)}, {"y", pixels(y)}}, text(plain));
}

Html svg_shape(double x, double y, std::size_t series, std::string_view css_class)
{
    return svg_path(fmt::format("M{} {}{}", pixels(x), pixels(y), shape_path(series)), css_class);
}

Html svg_cloud(const std::vector<std::pair<double, double>>& points, std::size_t series)
{
    std::string commands;
    for (const auto& [x, y] : points)
        commands += fmt::format("{}{} {}", commands.empty() ? "M" : "L", pixels(x), pixels(y));
    return points.empty() ? Html() : marked_path(commands, cloud_mark(series));
}

Html svg_samples(const std::vector<double>& places, double y)
{
    std::string commands;
    for (const double x : places)
        commands += commands.empty() ? fmt::format("M{} {}", pixels(x), pixels(y)) : "H" + pixels(x);
    return places.empty() ? Html() : marked_path(commands, sample_mark);
}

Html mark_definitions(const Html& markup)
{
    Html marks;
    for (std::size_t series = 0; series < series_marks; ++series)
        if (refers_to(markup, cloud_mark(series)))
            marks += mark_definition(cloud_mark(series), series_class(series),
                                     svg_path(std::string("M0 0").append(shape_path(series)), "cloud"));
    if (refers_to(markup, sample_mark)) marks += mark_definition(sample_mark, "", svg_path("M0 -3v6", "sample"));
    return marks.empty() ? marks
                         : element("svg", {{"class", "definitions"}, {"width", "0"}, {"height", "0"}},
                                   element("defs", {}, marks));
}

Html svg_mark(std::string_view css_class, const std::string& id, const std::string& tooltip, const Html& content)
{
    return element("g", {{"class", "mark " + std::string(css_class)}, {"data-row", id}},
                   element("title", {}, text(tooltip)) + content);
}

double text_width(std::string_view plain, double size)
{
    double width = 0;
    for (const char c : plain)
        if (!continues_character(c)) width += character_width(c);
    return width * size;
}

std::string shortened(const std::string& plain, double size, double width)
{
    if (text_width(plain, size) <= width) return plain;
    std::string kept;
    for (std::size_t begin = 0; begin < plain.size();) {
        std::size_t end = begin + 1;
        while (end < plain.size() && continues_character(plain[end]))
            ++end;
        const std::string longer = kept + plain.substr(begin, end - begin);
        if (text_width(longer + "…", size) > width) break;
        kept = longer;
        begin = end;
    }
    return kept + "…";
}

} // namespace tetrace
