#include "bench/report/charts/roofline_chart.h"

#include "bench/report/charts/axis.h"
#include "bench/report/html/svg.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace tetrace {

namespace {

constexpr double top = 24, left = 58, shortest_plot = 190, axis_room = 40;

struct RooflineFrame {
    Axis bytes, rate;
    double right, bottom;

    [[nodiscard]] double x(double bytes_per_step) const { return bytes.place(bytes_per_step, left, right); }
    [[nodiscard]] double y(double msteps_per_s) const { return rate.place(msteps_per_s, bottom, top); }
};

std::string point_text(const Roofline& roofline, const RooflinePoint& point)
{
    return fmt::format("{}  {}", short_percent(roofline.share(point)), point.label);
}

std::string roof_text(double bytes_per_s)
{
    return fmt::format("copying at {} GB/s", short_number(1e-9 * bytes_per_s));
}

double ceiling_of(double bytes_per_s, double bytes_per_step)
{
    return 1e-6 * bytes_per_s / bytes_per_step;
}

/// The plot reaches from half of the slowest row's rate to the roof over the row that loads least.
RooflineFrame frame_of(const Roofline& roofline)
{
    std::vector<double> loads;
    double slowest = std::numeric_limits<double>::max(), fastest = 0;
    const std::vector<double> roofs = roofline.bandwidths();
    const auto [lowest, highest] = std::ranges::minmax(roofs);
    double labels = 0;
    for (const double roof : roofs)
        labels = std::max(labels, text_width(roof_text(roof), label_size));
    for (const RooflinePoint& point : roofline.points) {
        loads.push_back(point.bytes_per_step);
        slowest = std::min(slowest, point.msteps_per_s);
        fastest = std::max(fastest, point.msteps_per_s);
        labels = std::max(labels, text_width(point_text(roofline, point), label_size));
    }
    const Axis bytes = Axis::logarithmic_at(loads, 1.5);
    const Axis rate = Axis::logarithmic(std::min(slowest, ceiling_of(lowest, bytes.high())),
                                        std::max(fastest, ceiling_of(highest, bytes.low())));
    const double labelled = side_label_pitch * static_cast<double>(roofline.points.size() + roofs.size());
    return {bytes, rate, side_labels_left(labels), top + std::max(shortest_plot, labelled)};
}

Html grid(const RooflineFrame& frame)
{
    return horizontal_ticks(frame.bytes, left, frame.right, top, frame.bottom) +
           vertical_ticks(frame.rate, left, frame.right, top, frame.bottom) + svg_text(0, 11, "small", "Msteps/s") +
           svg_text((left + frame.right) / 2, frame.bottom + 32, "small middle", "bytes per step");
}

/// The line spans the whole axis of bytes.
Html roof(double bytes_per_s, const RooflineFrame& frame, double label_y)
{
    const double low = frame.bytes.low(), high = frame.bytes.high();
    const double end = frame.y(ceiling_of(bytes_per_s, high));
    return svg_line(frame.x(low), frame.y(ceiling_of(bytes_per_s, low)), frame.x(high), end, "roof") +
           side_label(frame.right, end, frame.right, label_y, roof_text(bytes_per_s));
}

Html point_mark(const Roofline& roofline, const RooflinePoint& point, const RooflineFrame& frame, double label_y)
{
    const double x = frame.x(point.bytes_per_step), y = frame.y(point.msteps_per_s);
    const std::string label = point_text(roofline, point);
    const std::string tooltip = fmt::format("{} of the ceiling: {} of {} Msteps/s at {} bytes per step", label,
                                            short_number(point.msteps_per_s), short_number(roofline.ceiling(point)),
                                            short_number(point.bytes_per_step));
    return svg_mark(series_class(point.series), point.id, tooltip,
                    side_label(x, y, frame.right, label_y, label) + svg_shape(x, y, point.series, "solid"));
}

} // namespace

std::vector<double> Roofline::bandwidths() const
{
    std::vector<double> all;
    for (const RooflinePoint& point : points)
        all.push_back(bandwidth_over(point));
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::erase(all, copy_bytes_per_s);
    all.insert(all.begin(), copy_bytes_per_s);
    return all;
}

Html draw(const Roofline& roofline)
{
    const RooflineFrame frame = frame_of(roofline);
    const std::vector<double> roofs = roofline.bandwidths();
    std::vector<double> wanted;
    for (const double bandwidth : roofs)
        wanted.push_back(frame.y(ceiling_of(bandwidth, frame.bytes.high())));
    for (const RooflinePoint& point : roofline.points)
        wanted.push_back(frame.y(point.msteps_per_s));
    const auto places = spread_apart(wanted, side_label_pitch, top + 6, frame.bottom - 4);
    Html content = grid(frame);
    for (std::size_t i = 0; i < roofs.size(); ++i)
        content += roof(roofs[i], frame, places[i]);
    for (std::size_t i = 0; i < roofline.points.size(); ++i)
        content += point_mark(roofline, roofline.points[i], frame, places[roofs.size() + i]);
    return svg_drawing(frame.bottom + axis_room, roofline.label, content);
}

} // namespace tetrace
