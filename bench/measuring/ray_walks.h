#pragma once

#include "bench/rows/row_run.h"

namespace tetrace {

/// Walks the row's first ray that differs from openmp's and the first that the oracle finds wrong once more, and keeps
/// the walks in the row's record. Rows without such rays do not change. Throws only Error{interrupted}.
void note_walks(RowRun& row);

/// The command that follows a ray on the row's device and on openmp; empty for kernels that are not ours, or find no
/// hits. view: its
/// number in the camera set.
[[nodiscard]] std::string trace_command(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y);

/// `tetrace dump` of the ray's case, of any task, without --out; empty for kernels that are not ours.
[[nodiscard]] std::string dump_command(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y);

} // namespace tetrace
