#pragma once

#include "bench/debugging/trace_run.h"
#include "bench/output/report.h"

namespace tetrace {

/// The ray, its answers, and its steps: a line for each step that all devices take alike, else one for each way in
/// which they take it.
[[nodiscard]] Report trace_report(const TraceRun& run, const Options& options);

} // namespace tetrace
