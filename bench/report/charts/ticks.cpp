#include "bench/report/charts/ticks.h"

#include "bench/report/html/svg.h"

#include <limits>

namespace tetrace {

Html horizontal_ticks(const Axis& axis, double left, double right, double top, double bottom)
{
    Html ticks;
    double taken = std::numeric_limits<double>::lowest();
    for (const double tick : axis.ticks()) {
        const double x = axis.place(tick, left, right);
        ticks += svg_line(x, top, x, bottom, "grid");
        const std::string label = axis.label(tick);
        const double half = text_width(label, small_size) / 2;
        if (x - half < taken) continue;
        ticks += svg_text(x, bottom + 15, "small middle", label);
        taken = x + half + 6;
    }
    return ticks;
}

Html vertical_ticks(const Axis& axis, double left, double right, double top, double bottom)
{
    Html ticks;
    double taken = std::numeric_limits<double>::max();
    for (const double tick : axis.ticks()) {
        const double y = axis.place(tick, bottom, top);
        ticks += svg_line(left, y, right, y, "grid");
        if (y + small_size > taken) continue;
        ticks += svg_text(left - 6, y + 4, "small end", axis.label(tick));
        taken = y;
    }
    return ticks;
}

} // namespace tetrace
