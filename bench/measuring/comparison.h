#pragma once

#include "bench/rows/row_run.h"
#include "bench/statistics/rank_interval.h"

#include <optional>
#include <vector>

namespace tetrace {

/// The speed of a row compared with its reference.
struct Comparison {
    const RowRun* reference = nullptr;
    double ratio = 0; ///< row's rate over reference's, from medians of device seconds; above 1 the row is faster
    std::optional<FactorInterval> interval; ///< of the ratio, 95 %; empty where either has fewer than fewest_samples
};

/// The reference of each row, row by row: the same kernel on the same scene and the same hardware (see
/// physical_devices()), with schedule tiles. On the host the reference runs under openmp; on a GPU under cuda, else
/// under the first API that has it. A GPU's rows and the host's, which include emulations, are therefore never
/// compared. Empty for references themselves, Embree's rows, and rows without a rate.
[[nodiscard]] std::vector<std::optional<Comparison>> compare_rows(const std::vector<RowRun>& rows);

} // namespace tetrace
