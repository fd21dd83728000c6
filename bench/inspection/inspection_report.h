#pragma once

#include "bench/inspection/inspection.h"
#include "bench/output/report.h"

namespace tetrace {

/// The programs as a table, in all its forms, with a line for each target that could not be asked and for each fused
/// operation that exact mode forbids. JSON: results/README.md.
[[nodiscard]] Report inspection_report(const Inspection& inspection, const Options& options);

} // namespace tetrace
