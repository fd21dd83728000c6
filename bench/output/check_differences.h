#pragma once

#include "bench/rows/row_record.h"

#include <string>

namespace tetrace {

/// Full details of the row's first ray that differs from openmp's and the first that the oracle finds wrong: pixel,
/// view, hits, the tets of the walks on both sides, and the command that follows the ray. Empty if there is neither, or
/// the row is without hits.
[[nodiscard]] std::string differences_text(const RowRecord& row);

} // namespace tetrace
