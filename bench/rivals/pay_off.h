#pragma once

#include "bench/rows/row_run.h"
#include "bench/statistics/break_even.h"
#include "bench/statistics/interval.h"

#include <optional>

namespace tetrace {

/// Seconds of tracing with a structure that takes so much longer to build than another, and has `ratio` times its rate,
/// after which it has made up for the build; infinite: never.
[[nodiscard]] double seconds_until_paid(double more_s, double ratio);

/// What a timed row takes: building and packing once, and each ray. Empty if its session is closed.
[[nodiscard]] std::optional<TotalCost> total_cost(const RowRun& row);

/// The number of rays after which the walk takes less time than the other row, its build included; infinite: never.
/// Empty if a build time is unknown. Precondition: both rows have rates.
[[nodiscard]] std::optional<double> rays_until_paid(const RowRun& walk, const RowRun& other);

/// The same as seconds of tracing with the walk, with an interval from that of the ratio of their rates; infinite:
/// never. Empty if a build time is unknown.
[[nodiscard]] std::optional<Estimate> tracing_until_paid(const RowRun& walk, const RowRun& other);

} // namespace tetrace
