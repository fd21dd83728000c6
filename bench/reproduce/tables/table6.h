#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"
#include "bench/statistics/break_even.h"
#include "bench/statistics/paired_ratio.h"

#include <vector>

namespace tetrace {

/// A row of the CDT beside one of a BVH that traced the same views on the same device; Embree's stand beside openmp's.
struct RowPair {
    const SceneRun* run = nullptr;
    std::size_t cdt = 0, bvh = 0; ///< indices in SceneRun::rows; both have a rate
    PairedRatio ratio;            ///< the BVH's time over the CDT's
};

/// All pairs of a run, each row of the CDT with its rivals, in the order of rows.
[[nodiscard]] std::vector<RowPair> row_pairs(const SceneRun& run);

/// Those pairs whose row of the CDT is its device's fastest, by the time of all views.
[[nodiscard]] std::vector<RowPair> fastest_pairs(const SceneRun& run);

/// From how many rays on the CDT, or the BVH, has taken less time in all, its build included: first is the CDT. Empty
/// where the interval of their times' ratio holds 1, or what a build took is not known.
[[nodiscard]] std::optional<BreakEven> break_even(const RowPair& pair);

/// Table 6: frames of 1024 x 1024 a second, build time and memory of the CDT and of each BVH.
[[nodiscard]] PaperTable table6(const SceneRuns& runs);

/// Each layout of the CDT beside each BVH: their times' ratio over the views, when the builds are paid, and the claims.
[[nodiscard]] PaperTable table6_pairs(const SceneRuns& runs);

/// A figure a scene and type of device: the ratios of fastest_pairs(), ascending, over the share of the views.
[[nodiscard]] std::vector<PaperFigure> table6_figures(const SceneRuns& runs);

} // namespace tetrace
