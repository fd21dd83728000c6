#pragma once

#include "bench/rows/row_record.h"
#include "bench/statistics/interval.h"

#include <optional>

namespace tetrace {

/// Seconds of tracing with a structure that takes this much longer to build than another, and has `ratio` times its
/// rate, after which it has made up for the build; infinite: never.
[[nodiscard]] double seconds_until_paid(double more_s, double ratio);

/// The same of a walk and another row, builds and packing counted, with an interval from that of the ratio of their
/// rates. Empty if a build time is unknown. Precondition: both rows have rates.
[[nodiscard]] std::optional<Estimate> tracing_until_paid(const RowRecord& walk, const RowRecord& other);

} // namespace tetrace
