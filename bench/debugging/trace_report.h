#pragma once

#include "bench/debugging/trace_run.h"
#include "bench/output/report.h"

namespace tetrace {

/// What shown_trace() makes of the ray, and the result that `show` makes the same of.
[[nodiscard]] Report trace_report(const TraceRun& run, const Options& options);

} // namespace tetrace
