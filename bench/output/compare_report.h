#pragma once

#include "bench/output/report.h"
#include "bench/results/result_comparison.h"

namespace tetrace {

/// A comparison for people, as a flat table, and as JSON (the section `comparison` of results/README.md).
/// A file, and what made it, on what, when.
[[nodiscard]] std::string source_text(const ResultFile& file);

/// Every row of both, flat.
[[nodiscard]] Table flat_rows(const ResultComparison& comparison);

/// As results record it.
[[nodiscard]] nlohmann::json comparison_json(const ResultComparison& comparison, bool allow_missing);

[[nodiscard]] Report compare_report(const ResultComparison& comparison, const Options& options);

} // namespace tetrace
