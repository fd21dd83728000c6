#pragma once

#include "bench/rows/row_run.h"

#include <cstddef>
#include <span>

namespace tetrace {

/// What a row's rays of a view (an index in SceneWork::views()) visit in a BVH, counted by openmp's counting build of
/// the kernels. Empty for rows of other structures, of Embree and of other backends, whose answers are openmp's. hits:
/// the row's own. Throws Error{internal} if the counting build's answers differ.
[[nodiscard]] Visits count_visits(const RowRun& row, std::size_t view, std::span<const Hit> hits, unsigned threads);

/// The same of one of these rays.
[[nodiscard]] Visits count_visits_of_ray(const RowRun& row, std::size_t view, std::span<const Hit> hits,
                                         std::size_t ray, unsigned threads);

} // namespace tetrace
