#pragma once

#include "bench/rows/row_run.h"

#include <vector>

namespace tetrace {

/// What a row's rays need of its packed scene.
struct MetParts {
    std::vector<bool> tets;      ///< that a ray is in before it ends, by packed position
    std::vector<bool> triangles; ///< that a ray hits, by number in the mesh
};

/// Over all views. Traces each view once for each step of its longest walk. row: open on openmp, of tets, of task trace
/// or rays. Throws what the session throws.
[[nodiscard]] MetParts met_parts(RowRun& row);

/// The row's packed scene with zeros for all else, so that it compresses to less. The same as it is where that changed
/// an answer, and for other structures and tasks. Throws what the session throws.
[[nodiscard]] PackedScene with_met_parts_only(RowRun& row);

} // namespace tetrace
