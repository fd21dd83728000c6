#pragma once

#include "bench/output/bench_report.h"
#include "bench/results/result_file.h"
#include "bench/terminal/sheet.h"

namespace tetrace {

/// A run again, for people and flat.
struct RunAgain {
    Sheet sheet;
    Table table;
};

/// What a run of `bench` or `check` printed, made from its result by what made it then. A line at the end names what
/// the result does not have. Throws Error{invalid_input} for results of other verbs, and as read_rows() does.
[[nodiscard]] RunAgain run_again(const ResultFile& file);

/// A result's `load` and `pulses`, and how many of its rows and searches were timed, noisy and disturbed.
[[nodiscard]] Steadiness read_steadiness(const ResultValue& section);

} // namespace tetrace
