#pragma once

#include "bench/output/report.h"
#include "bench/results/result_comparison.h"

namespace tetrace {

/// Several results, each compared with the first: a column a result, with rates and their ratios to the first's. A row
/// has a line where at least one other result did the same work; the others are listed with the reason.
[[nodiscard]] Report side_by_side(const std::vector<ResultComparison>& comparisons, const Options& options);

} // namespace tetrace
