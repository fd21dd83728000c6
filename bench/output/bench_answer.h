#pragma once

#include "bench/output/bench_report.h"

namespace tetrace {

/// What a run found, in three lines: the fastest row of each scene; CDT beside BVH, and each API beside openmp; whether
/// to trust the rates. Empty where nothing was timed.
[[nodiscard]] Sheet answer_of(const BenchResult& result);

} // namespace tetrace
