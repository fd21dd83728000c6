#pragma once

#include "bench/report/html/html.h"

#include <utility>
#include <vector>

namespace tetrace {

struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points; ///< x, y; finite
};

/// Series over a common pair of axes, linear by default; titles include their units.
struct LineChart {
    std::string label, x_title, y_title;
    std::vector<Series> series;
    bool x_logarithmic = false, y_logarithmic = false;
    bool x_dates = false; ///< x are days since 1970-01-01 UTC
    bool x_whole = false; ///< x are counts, and their axis starts at the lowest
};

/// A series whose x ascend is drawn as a line, any other as a cloud of its shape; its name, with its shape before it,
/// is next to its last point. Up to series_marks series have marks that differ (bench/report/html/svg.h). The drawing
/// grows with the number of series, so that every name fits. A linear axis of non-negative values starts at zero,
/// unless they fill less than half of it. Precondition: each series has at least one point; values on a logarithmic
/// axis are positive.
[[nodiscard]] Html draw(const LineChart& chart);

} // namespace tetrace
