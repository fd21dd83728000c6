#pragma once

#include "bench/rows/row_run.h"
#include "bench/statistics/median_ratio.h"

#include <optional>
#include <vector>

namespace tetrace {

/// How fast a row is beside its reference.
struct Comparison {
    const RowRun* reference = nullptr;
    MedianRatio rate; ///< the row's over the reference's, of the medians of device seconds; above 1 the row is faster
};

/// What each row compares with, row by row: the same kernel on the same scene and the same hardware (see
/// physical_devices()), with schedule tiles, under openmp on the host, and under cuda, else the first API that has it,
/// on a GPU. So a GPU's rows and the host's, emulations among them, are never compared. Empty for references
/// themselves, Embree's rows, and rows without a rate.
[[nodiscard]] std::vector<std::optional<Comparison>> compare_rows(const std::vector<RowRun>& rows);

} // namespace tetrace
