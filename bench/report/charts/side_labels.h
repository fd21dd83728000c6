#pragma once

#include "bench/report/html/html.h"

namespace tetrace {

/// Least distance between the labels in the column to the right of a plot.
inline constexpr double side_label_pitch = 17;

/// Where a plot must end so that labels of that width fit to its right; the plot keeps at least half of the drawing.
[[nodiscard]] double side_labels_left(double widest_label);

/// A label right of a plot that ends at plot_right, at height label_y, with a thin line from the point that it labels.
[[nodiscard]] Html side_label(double point_x, double point_y, double plot_right, double label_y,
                              const std::string& label);

} // namespace tetrace
