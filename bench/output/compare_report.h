#pragma once

#include "bench/output/report.h"
#include "bench/results/result_comparison.h"

namespace tetrace {

/// A comparison for people, as a flat table, and as JSON (the section `comparison` of results/README.md).
[[nodiscard]] Report compare_report(const ResultComparison& comparison, const Options& options);

} // namespace tetrace
