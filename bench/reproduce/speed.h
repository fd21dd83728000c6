#pragma once

#include "bench/reproduce/claims.h"
#include "bench/reproduce/scene_run.h"

#include <vector>

namespace tetrace {

/// The cdt's methods but maria, in the order of all_kernels().
[[nodiscard]] const std::vector<Method>& older_methods();

/// Device seconds of each view: the medians of its samples. Empty for a row without a rate.
[[nodiscard]] std::vector<double> view_seconds(const SceneRun& run, std::size_t row);

/// Tets that a ray leaves on average, view by view.
[[nodiscard]] std::vector<double> view_steps(const SceneRun& run, std::size_t row);

/// "bunny maria tet80 openmp": a row in a figure.
[[nodiscard]] std::string series_name(const SceneRun& run, const RowRun& row);

// Claims of speed: where a row that they are about is noisy, they are not testable.

/// "maria is the fastest of the five on CPU", scene by scene: the time of each older method over maria's in the same
/// views and layout, on openmp. Not testable unless all of them have a rate.
[[nodiscard]] Claim fastest_claim(const SceneRuns& runs);

/// "On a GPU plucker overtakes stp", on every GPU and scene: stp's time over plucker's.
[[nodiscard]] Claim overtaking_claim(const SceneRuns& runs);

/// "Time is proportional to the tets traversed", for the rows of one type of device ("cpu", "gpu"): the correlation
/// over the views is above 0.9 in each.
[[nodiscard]] Claim proportional_claim(const SceneRuns& runs, const std::string& type);
inline constexpr double proportional_above = 0.9;

} // namespace tetrace
