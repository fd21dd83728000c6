#pragma once

#include "bench/rows/row_run.h"

namespace tetrace {

/// Walks the row's first ray that differs from openmp's and the first that the oracle finds wrong once more, and keeps
/// the walks in the row's record. Rows without such rays do not change. Throws only Error{interrupted}.
void note_walks(RowRun& row);

} // namespace tetrace
