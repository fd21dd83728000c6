#pragma once

#include "bench/report/html/html.h"

#include <vector>

namespace tetrace {

/// A row under the roof of its device.
struct RooflinePoint {
    std::string id, label;
    std::size_t series = 0;
    double bytes_per_step = 0;   ///< bytes that a step loads from its tet's record; positive
    double msteps_per_s = 0;     ///< positive
    double copy_bytes_per_s = 0; ///< of the level of memory that holds its scene; 0: the roofline's own
};

/// A device's roof, in the units of the walk: with steps that load b bytes each, memory allows at most bandwidth / b
/// steps per second.
/// Source: Williams, Waterman, Patterson, "Roofline: An Insightful Visual Performance Model" (2009). Its horizontal
/// axis, operations per byte, is inverted here to bytes per step. There is not a flat part, because no step rate is
/// given for arithmetic only.
struct Roofline {
    std::string label;
    double copy_bytes_per_s = 0; ///< positive; of memory
    std::vector<RooflinePoint> points;

    /// Msteps/s that memory allows.
    [[nodiscard]] double ceiling(double bytes_per_step) const { return 1e-6 * copy_bytes_per_s / bytes_per_step; }
    /// Msteps/s that the level of memory that holds the point's scene allows.
    [[nodiscard]] double ceiling(const RooflinePoint& point) const
    {
        return 1e-6 * bandwidth_over(point) / point.bytes_per_step;
    }
    [[nodiscard]] double bandwidth_over(const RooflinePoint& point) const
    {
        return point.copy_bytes_per_s > 0 ? point.copy_bytes_per_s : copy_bytes_per_s;
    }
    /// 1 is on the roof. Above 1, nearer caches serve part of what the roof counts as traffic.
    [[nodiscard]] double share(const RooflinePoint& point) const { return point.msteps_per_s / ceiling(point); }
    /// The bandwidths of the roofs: memory's first, then those of other levels over points, ascending.
    [[nodiscard]] std::vector<double> bandwidths() const;
};

/// Both axes are logarithmic; every point has its label and its share of its own ceiling; a line for each level.
/// Precondition: there is at least one point.
[[nodiscard]] Html draw(const Roofline& roofline);

} // namespace tetrace
