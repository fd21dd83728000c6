#pragma once

#include "bench/rows/row_run.h"
#include "bench/statistics/break_even.h"
#include "bench/statistics/interval.h"

#include <optional>

namespace tetrace {

/// What a timed row takes: building and packing once, and each ray. Empty if its session is closed.
[[nodiscard]] std::optional<TotalCost> total_cost(const RowRun& row);

/// The number of rays after which the walk takes less time than the other row, its build included; infinite: never.
/// Empty if a build time is unknown. Precondition: both rows have rates.
[[nodiscard]] std::optional<double> rays_until_paid(const RowRun& walk, const RowRun& other);

/// The same as seconds of tracing with the walk, with an interval from that of the ratio of their rates; infinite:
/// never. Empty if a build time is unknown.
[[nodiscard]] std::optional<Estimate> tracing_until_paid(const RowRun& walk, const RowRun& other);

} // namespace tetrace
