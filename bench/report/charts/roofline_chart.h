#pragma once

#include "bench/report/html/html.h"

#include <vector>

namespace tetrace {

/// A row under the roof of its device.
struct RooflinePoint {
    std::string id, label;
    std::size_t series = 0;
    double bytes_per_step = 0; ///< bytes that a step loads from its tet's record; positive
    double msteps_per_s = 0;   ///< positive
};

/// A device's roof, in the units of the walk: with steps that load b bytes each, memory allows at most bandwidth / b
/// steps a second.
/// Source: Williams, Waterman, Patterson, "Roofline: An Insightful Visual Performance Model" (2009). Its horizontal
/// axis, operations per byte, is inverted here to bytes per step. There is no flat part, because no step rate is given
/// for arithmetic alone.
struct Roofline {
    std::string label;
    double copy_bytes_per_s = 0; ///< positive
    std::vector<RooflinePoint> points;

    /// Msteps/s that memory allows.
    [[nodiscard]] double ceiling(double bytes_per_step) const { return 1e-6 * copy_bytes_per_s / bytes_per_step; }
    /// 1 is on the roof. Above 1, caches serve part of what the roof counts as memory traffic.
    [[nodiscard]] double share(const RooflinePoint& point) const
    {
        return point.msteps_per_s / ceiling(point.bytes_per_step);
    }
};

/// Both axes are logarithmic; every point has its label and its share of the ceiling. Precondition: there is at least
/// one point.
[[nodiscard]] Html draw(const Roofline& roofline);

} // namespace tetrace
