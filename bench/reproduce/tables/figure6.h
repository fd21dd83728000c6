#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"

#include <utility>
#include <vector>

namespace tetrace {

/// Figure 6: time and tets traversed, one point per view. One figure for each scene and type of device
/// ("figure6-bunny-gpu"); the scene's pictures are in its first figure. A scene without a rated row has one figure
/// without points.
/// runs: timed.
[[nodiscard]] std::vector<PaperFigure> figure6(const SceneRuns& runs);

/// The same as a table: range of tets and of times, correlation and line of each row; and the claims, which cover all
/// scenes and devices.
[[nodiscard]] PaperTable figure6_table(const SceneRuns& runs);

/// The views (indices) in which a row's rays leave the fewest and the most tets.
[[nodiscard]] std::pair<std::size_t, std::size_t> extreme_views(const SceneRun& run, std::size_t row);

} // namespace tetrace
