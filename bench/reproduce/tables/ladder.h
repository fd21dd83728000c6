#pragma once

#include "bench/measuring/lone_rays.h"
#include "bench/reproduce/tables/paper_table.h"

#include <vector>

namespace tetrace {

// The latency ladder is not in the paper: what a step costs as a scene outgrows one cache after the other.

/// Nanoseconds per step of each row, in the full device and of a ray alone, by the bytes that the row's structure has.
/// rows, costs: of the same index belong together.
[[nodiscard]] PaperTable ladder_table(const std::vector<RowRecord>& rows, const std::vector<StepCosts>& costs);

/// A figure per device ("ladder-cuda"): both by bytes, with a series per layout.
[[nodiscard]] std::vector<PaperFigure> ladder_figures(const std::vector<RowRecord>& rows,
                                                      const std::vector<StepCosts>& costs);

} // namespace tetrace
