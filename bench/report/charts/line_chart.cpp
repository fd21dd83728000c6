#include "bench/report/charts/line_chart.h"

#include "bench/report/charts/axis.h"
#include "bench/report/html/svg.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace tetrace {

namespace {

constexpr double top = 24, min_bottom = 264, left = 62, axis_room = 40;

/// Margin between the first and the last label and the plot's ends.
constexpr double above_labels = 6, below_labels = 4;

/// Lines with up to this number of points mark each point with their shape; longer ones some.
constexpr std::size_t max_marked = 24, marks_of_long_line = 8;

struct Range {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();

    void hold(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    /// A range of non-negative values begins at zero where the values still fill at least half of it.
    [[nodiscard]] Axis axis(int intervals, bool logarithmic) const
    {
        if (logarithmic) return Axis::logarithmic(low, high);
        return Axis::linear(low >= 0 && low <= high / 2 ? 0 : low, high, intervals);
    }
};

struct LineFrame {
    Axis x_axis, y_axis;
    double right, bottom;

    [[nodiscard]] double x(double value) const { return x_axis.place(value, left, right); }
    [[nodiscard]] double y(double value) const { return y_axis.place(value, bottom, top); }
};

/// The bottom of a column of this many labels.
double bottom_of(std::size_t labels)
{
    const double column = side_label_pitch * static_cast<double>(std::max<std::size_t>(labels, 1) - 1);
    return std::max(min_bottom, top + above_labels + column + below_labels);
}

Axis x_axis_of(const LineChart& chart, const Range& x)
{
    constexpr int max_intervals = 4;
    if (chart.x_dates) return Axis::dates(x.low, x.high);
    if (chart.x_whole)
        return Axis::linear(x.low, x.high, std::clamp(static_cast<int>(x.high - x.low), 1, max_intervals));
    return x.axis(max_intervals, chart.x_logarithmic);
}

LineFrame frame_of(const LineChart& chart)
{
    Range x, y;
    double names = 0;
    for (const Series& series : chart.series) {
        for (const auto& point : series.points) {
            x.hold(point.first);
            y.hold(point.second);
        }
        names = std::max(names, side_key_width + text_width(series.name, label_size));
    }
    return {x_axis_of(chart, x), y.axis(5, chart.y_logarithmic), side_labels_left(names),
            bottom_of(chart.series.size())};
}

Html grid(const LineChart& chart, const LineFrame& frame)
{
    return horizontal_ticks(frame.x_axis, left, frame.right, top, frame.bottom) +
           vertical_ticks(frame.y_axis, left, frame.right, top, frame.bottom) +
           svg_text(0, 11, "small", chart.y_title) +
           svg_text((left + frame.right) / 2, frame.bottom + 32, "small middle", chart.x_title);
}

bool ascends(const Series& series)
{
    return std::ranges::is_sorted(series.points, [](const auto& a, const auto& b) { return a.first < b.first; });
}

Html points_of(const Series& series, std::size_t number, const LineFrame& frame)
{
    std::vector<std::pair<double, double>> places;
    for (const auto& [x, y] : series.points)
        places.emplace_back(frame.x(x), frame.y(y));
    if (!ascends(series)) return svg_cloud(places, number);
    std::string line;
    Html shapes;
    const std::size_t stride = places.size() <= max_marked ? 1 : places.size() / marks_of_long_line;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& [x, y] = places[i];
        line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x, y);
        if (i % stride == 0) shapes += svg_shape(x, y, number, "solid");
    }
    return svg_path(line, "line") + shapes;
}

} // namespace

Html draw(const LineChart& chart)
{
    const LineFrame frame = frame_of(chart);
    std::vector<double> wanted;
    for (const Series& series : chart.series)
        wanted.push_back(series.points.empty() ? frame.bottom : frame.y(series.points.back().second));
    const auto places = spread_apart(wanted, side_label_pitch, top + above_labels, frame.bottom - below_labels);
    Html content = grid(chart, frame);
    for (std::size_t i = 0; i < chart.series.size(); ++i) {
        const Series& series = chart.series[i];
        if (series.points.empty()) continue;
        content += svg_mark(
            series_class(i), series.name, fmt::format("{}: {} points", series.name, series.points.size()),
            side_label(frame.x(series.points.back().first), wanted[i], frame.right, places[i], series.name, i) +
                points_of(series, i, frame));
    }
    return svg_drawing(frame.bottom + axis_room, chart.label, content);
}

} // namespace tetrace
