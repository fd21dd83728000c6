#pragma once

#include "bench/output/report.h"
#include "bench/results/result_comparison.h"

namespace tetrace {

/// A file, and what made it, on what, when: as text, and as results record it.
[[nodiscard]] std::string source_text(const ResultFile& file);
[[nodiscard]] nlohmann::json source_json(const ResultFile& file);

/// What A and B are, in what they differ apart from rows, and the devices of compared rows.
[[nodiscard]] Sheet comparison_head(const ResultComparison& comparison);

/// How many rows were compared, with which verdicts, and the geometric mean.
[[nodiscard]] std::string summary_text(const ResultComparison& comparison);

/// A line that says what the rates of searches are, where any of these rows is one.
void add_search_note(Sheet& sheet, const ResultComparison& comparison);

/// Every row of both, flat.
[[nodiscard]] Table flat_rows(const ResultComparison& comparison);

/// As results record it.
[[nodiscard]] nlohmann::json comparison_json(const ResultComparison& comparison, bool allow_missing);

/// A comparison for people, as a flat table, and as JSON (the section `comparison` of results/README.md).
[[nodiscard]] Report compare_report(const ResultComparison& comparison, const Options& options);

} // namespace tetrace
