#pragma once

#include "bench/measuring/budget.h"
#include "bench/rows/row_run.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tetrace {

/// What a step costs a row: a tet left, or a node of a BVH visited. In a full device many rays hide each other's
/// waiting for memory; a ray alone waits for every step.
struct StepCosts {
    double steps = 0;            ///< of all rays of the first view; 0: not known
    std::vector<double> alone_s; ///< device seconds per step of a ray alone, round by round; empty if not measured
};

/// Traces single rays of a row, each by itself in a launch, in rounds. A round first traces all rays of the first view,
/// which leaves the caches as such rays leave them. Then it launches 64 other rays of that view, one by one. Launching
/// takes as long for short rays as for long ones, so the slope of seconds over steps is that of a step: the median of
/// the longer half less that of the shorter half. openmp, whose threads trace one ray after the other, gets 32 rays of
/// similar length in a launch, which one thread traces; all others a ray in an otherwise idle subgroup. Each hit must
/// equal that of the whole view, which was verified; otherwise the row ends with the reason.
///
/// row: open, timed, of random rays, which start outside the domain. nodes: that each ray of the first view visits, for
/// a row of a BVH (visited_nodes()); empty otherwise. The last rounds are left out if the budget has no time for them.
void measure_steps(RowRun& row, StepCosts& costs, const std::vector<double>& nodes, unsigned rounds,
                   const Budget& budget);

/// Nodes that each ray of a view visits in a row's BVH, as openmp traces it; empty for rows of other structures.
[[nodiscard]] std::vector<double> visited_nodes(const RowRun& row, std::size_t view);

/// What one launch took, and the steps of its rays.
struct LoneLaunch {
    double steps, seconds;
};
/// Seconds per step: the median seconds of the longer half of launches less that of the shorter, over the same of the
/// steps. Empty if the halves have equal steps.
[[nodiscard]] std::optional<double> slope_of(std::vector<LoneLaunch> launches);

} // namespace tetrace
