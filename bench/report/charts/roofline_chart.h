#pragma once

#include "bench/report/html/html.h"

#include <vector>

namespace tetrace {

/// A row under the roof of its device.
struct RooflinePoint {
    std::string id, label;
    std::size_t series = 0;
    double bytes_per_step = 0; ///< what a step loads of its tet's record; positive
    double msteps_per_s = 0;   ///< positive
};

/// A device's roof, in the units of the walk: a step that loads b bytes cannot come from memory more often than
/// bandwidth / b times a second.
/// Source: Williams, Waterman, Patterson, "Roofline: An Insightful Visual Performance Model" (2009), whose horizontal
/// axis, operations a byte, is here turned round to bytes a step; there is no flat part, for no step rate is given that
/// arithmetic alone would allow.
struct Roofline {
    std::string label;
    double copy_bytes_per_s = 0; ///< positive
    std::vector<RooflinePoint> points;

    /// Msteps/s that memory allows.
    [[nodiscard]] double ceiling(double bytes_per_step) const { return 1e-6 * copy_bytes_per_s / bytes_per_step; }
    /// 1 is on the roof; above it caches serve what the roof takes for memory's.
    [[nodiscard]] double share(const RooflinePoint& point) const
    {
        return point.msteps_per_s / ceiling(point.bytes_per_step);
    }
};

/// Both axes logarithmic; every point with its label and share of the ceiling. Precondition: there is a point.
[[nodiscard]] Html draw(const Roofline& roofline);

} // namespace tetrace
