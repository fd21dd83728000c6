#pragma once

#include "bench/report/charts/axis.h"
#include "bench/report/html/html.h"

namespace tetrace {

/// Grid lines with their labels: of a horizontal axis under the plot, of a vertical one left of it. A label that its
/// neighbour leaves no room for is left out.
[[nodiscard]] Html horizontal_ticks(const Axis& axis, double left, double right, double top, double bottom);
[[nodiscard]] Html vertical_ticks(const Axis& axis, double left, double right, double top, double bottom);

} // namespace tetrace
