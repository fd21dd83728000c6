#pragma once

#include "bench/reproduce/tables/paper_table.h"
#include "bench/truth/uniform_lines.h"

#include <string>
#include <vector>

namespace tetrace {

// Rows of tasks segments, tally and absorb, which are not in the paper (docs/volume.md).

/// The uniform lines of a scene, by its name in rows.
struct SceneLines {
    std::string scene;
    LineTest test;
};

/// Each row once, with its hash, on how many devices its answers have that hash, what the oracle says of its rays, and
/// its rate on each device. Claims: equal bits everywhere; sums that add up; no ray of method project lost or wrong.
[[nodiscard]] PaperTable volume_table(const std::vector<RowRecord>& rows);

/// The lengths of uniform lines in each scene's tets, and the claim that they are as integral geometry has them.
[[nodiscard]] PaperTable volume_lines_table(const std::vector<SceneLines>& lines);

} // namespace tetrace
