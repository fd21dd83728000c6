#pragma once

#include "bench/report/charts/axis.h"
#include "bench/report/html/html.h"

namespace tetrace {

/// Grid lines with their labels: below the plot for a horizontal axis, left of it for a vertical one. A label is left
/// out if its neighbour leaves no space for it.
[[nodiscard]] Html horizontal_ticks(const Axis& axis, double left, double right, double top, double bottom);
[[nodiscard]] Html vertical_ticks(const Axis& axis, double left, double right, double top, double bottom);

} // namespace tetrace
