#pragma once

#include "bench/report/html/html.h"

#include <utility>
#include <vector>

namespace tetrace {

/// Width of charts and height of their text, in pixels. The width is small enough that text stays legible where a phone
/// scales the drawing down, and that two charts fit side by side elsewhere.
inline constexpr double chart_width = 480;
inline constexpr double label_size = 13;
inline constexpr double small_size = 11.5;

/// Number of series colours, and of shapes: CSS classes s0 to s6, with the colours of Okabe and Ito, "Color Universal
/// Design" (2008). In the first series, each colour has its own shape, so that colour is never the only cue.
inline constexpr std::size_t series_styles = 7;
/// Number of series before their marks repeat: after each 7 series every colour gets the next shape and dash, and after
/// 49 the shapes are open.
inline constexpr std::size_t series_marks = 2 * series_styles * series_styles;
/// The CSS classes of a series: its colour, its dash, and "open" where its shapes are.
[[nodiscard]] std::string series_class(std::size_t series);

/// The svg element, chart_width wide; a screen reader reads `label` instead of it.
[[nodiscard]] Html svg_drawing(double height, const std::string& label, const Html& content);

[[nodiscard]] Html svg_line(double x1, double y1, double x2, double y2, std::string_view css_class);
[[nodiscard]] Html svg_rectangle(double x, double y, double width, double height, std::string_view css_class);
[[nodiscard]] Html svg_path(const std::string& commands, std::string_view css_class);

/// Text with its baseline at y; the class says which point of the text is at x: "end", "middle", or by default its
/// start.
[[nodiscard]] Html svg_text(double x, double y, std::string_view css_class, std::string_view plain);

/// The shape of a series, centred.
[[nodiscard]] Html svg_shape(double x, double y, std::size_t series, std::string_view css_class);

/// Many points as one path, which takes an eighth of the bytes that a shape for each would take. points: x, y. The page
/// needs mark_definitions().
[[nodiscard]] Html svg_cloud(const std::vector<std::pair<double, double>>& points, std::size_t series);
/// The same for the samples of a bar: a tick at each x.
[[nodiscard]] Html svg_samples(const std::vector<double>& places, double y);
/// What the clouds and samples of this markup refer to, once for a page; empty if it has none.
[[nodiscard]] Html mark_definitions(const Html& markup);

/// The group that one row or point is drawn with; tests count these. The tooltip appears under the pointer.
[[nodiscard]] Html svg_mark(std::string_view css_class, const std::string& id, const std::string& tooltip,
                            const Html& content);

/// Width of a text in pixels in a wide sans-serif face (DejaVu Sans); other faces need less.
[[nodiscard]] double text_width(std::string_view plain, double size);

/// The text, or as much of its beginning as fits, with an ellipsis.
[[nodiscard]] std::string shortened(const std::string& plain, double size, double width);

} // namespace tetrace
