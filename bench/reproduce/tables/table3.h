#pragma once

#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"

#include <vector>

namespace tetrace {

/// Table 3: tets, faces and memory of each scene in each build.
[[nodiscard]] PaperTable table3(const SceneRuns& runs);

/// The speed of those builds: rates of every row.
[[nodiscard]] PaperTable table3_rates(const SceneRuns& runs);

} // namespace tetrace
