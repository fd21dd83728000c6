#pragma once

#include "bench/measuring/budget.h"
#include "bench/options/benchmark_flags.h"
#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace tetrace {

/// What the timed part came to; the samples are in the rows.
struct Measurement {
    unsigned samples = 0;            ///< a row
    bool lowered = false;            ///< fewer than asked for, for the budget's sake
    nlohmann::json google_benchmark; ///< its own JSON: context and benchmarks; null where nothing was timed
    double wall_s = 0;
};

/// Samples that fit the budget: those asked for, or fewer, but 5 at least where as many were asked for.
/// sweep_s: what one sample of every row is expected to take. left_s: of the budget.
[[nodiscard]] unsigned affordable_samples(unsigned asked, double sweep_s, double left_s);

/// Takes samples of every row that is ok or flawed, with Google Benchmark, interleaved at random, after an untimed pass
/// of each. One sample traces all selected views once; its seconds are the sum of the device's. Afterwards the hits of
/// the last view must still be those that were verified. Rows that fail end with their reason, and so do those that the
/// budget has no time for.
[[nodiscard]] Measurement measure_rows(std::vector<RowRun>& rows, const Options& options, const BenchmarkFlags& flags,
                                       Budget& budget = no_budget());

} // namespace tetrace
