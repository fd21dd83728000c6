#pragma once

#include "bench/report/html/html.h"

#include <optional>

namespace tetrace {

/// Least distance between the labels in the column to the right of a plot.
inline constexpr double side_label_pitch = 17;

/// Room for a series' shape before its label.
inline constexpr double side_key_width = 13;

/// Where a plot must end so that labels of that width fit to its right; the plot keeps at least half of the drawing.
[[nodiscard]] double side_labels_left(double max_label);

/// A label right of a plot that ends at plot_right, at height label_y, with a thin line from the point that it labels,
/// and with the shape of its series before it where one is given.
[[nodiscard]] Html side_label(double point_x, double point_y, double plot_right, double label_y,
                              const std::string& label, std::optional<std::size_t> series = {});

} // namespace tetrace
