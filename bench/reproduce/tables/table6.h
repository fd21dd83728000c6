#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"
#include "bench/statistics/break_even.h"
#include "bench/statistics/paired_ratio.h"

#include <vector>

namespace tetrace {

/// A row of the CDT and one of a BVH that traced the same views on the same device; Embree's rows pair with openmp's.
struct RowPair {
    const SceneRun* run = nullptr;
    std::size_t cdt = 0, bvh = 0; ///< indices in SceneRun::rows; both have a rate
    PairedRatio ratio;            ///< the BVH's time over the CDT's
};

/// All pairs of a run, each row of the CDT with its rivals, in the order of rows.
[[nodiscard]] std::vector<RowPair> row_pairs(const SceneRun& run);

/// The pairs whose CDT row is its device's fastest, by the time of all views.
[[nodiscard]] std::vector<RowPair> fastest_pairs(const SceneRun& run);

/// The number of rays from which the CDT, or the BVH, takes less time in total, including its build; first is the CDT.
/// Empty where the interval of the ratio of their times contains 1, or a build time is unknown.
[[nodiscard]] std::optional<BreakEven> break_even(const RowPair& pair);

/// Table 6: frames of 1024 x 1024 a second, build time and memory of the CDT and of each BVH.
[[nodiscard]] PaperTable table6(const SceneRuns& runs);

/// Each layout of the CDT with each BVH: the ratio of their times over the views, when the builds pay off, and the
/// claims.
[[nodiscard]] PaperTable table6_pairs(const SceneRuns& runs);

/// One figure for each scene and type of device: the ratios of fastest_pairs(), ascending, over the share of the views.
[[nodiscard]] std::vector<PaperFigure> table6_figures(const SceneRuns& runs);

} // namespace tetrace
