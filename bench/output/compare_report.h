#pragma once

#include "bench/output/report.h"
#include "bench/results/result_comparison.h"

namespace tetrace {

/// A comparison for people, as a flat table, and as JSON (the section `comparison` of results/README.md).
/// A file, and what made it, on what, when.
[[nodiscard]] std::string source_text(const ResultFile& file);

/// How many rows were compared, with which verdicts, and the geometric mean.
[[nodiscard]] std::string summary_text(const ResultComparison& comparison);

/// A line that says what the rates of searches are, where any of these rows is one.
void add_search_note(Sheet& sheet, const ResultComparison& comparison);

/// Every row of both, flat.
[[nodiscard]] Table flat_rows(const ResultComparison& comparison);

/// As results record it.
[[nodiscard]] nlohmann::json comparison_json(const ResultComparison& comparison, bool allow_missing);

[[nodiscard]] Report compare_report(const ResultComparison& comparison, const Options& options);

} // namespace tetrace
