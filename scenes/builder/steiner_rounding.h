#pragma once

#include "core/mesh/tet_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// How far a vertex may move to mend a tet, in steps of 2^-24 per axis.
struct Freedom {
    std::array<bool, 3> axes = {false, false, false};
    std::uint32_t steps = 0;
};

/// Tries floats near the movable vertices of each flat or inverted tet, nearest first, and keeps one that leaves fewer
/// bad tets around it. Deterministic; vertices without freedom never move; the number of tries is bounded.
/// Returns {bad before, bad after, vertices moved}.
std::array<std::uint64_t, 3> mend_tets(TetMesh& mesh, const std::vector<Freedom>& freedom);

} // namespace tetrace
