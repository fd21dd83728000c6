#include "bench/report/charts/side_labels.h"

#include "bench/report/html/svg.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {
constexpr double leader = 22; ///< length of the slanted part of the line, and space around it
} // namespace

double side_labels_left(double max_label)
{
    return std::max(chart_width / 2, chart_width - max_label - leader - 1);
}

Html side_label(double point_x, double point_y, double plot_right, double label_y, const std::string& label,
                std::optional<std::size_t> series)
{
    const double end = plot_right + leader, start = end + (series ? side_key_width : 0);
    return svg_path(fmt::format("M{:.1f} {:.1f}H{:.1f}L{:.1f} {:.1f}", point_x, point_y, plot_right, end - 4, label_y),
                    "leader") +
           (series ? svg_shape(end + 3, label_y, *series, "solid") : Html()) +
           svg_text(start, label_y + 4.5, "label", shortened(label, label_size, chart_width - start));
}

} // namespace tetrace
