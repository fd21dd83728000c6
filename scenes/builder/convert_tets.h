#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/tet_mesh.h"
#include "scenes/builder/raw_tets.h"

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

/// What rounding Steiner points to float did.
struct Rounding {
    std::uint64_t damaged = 0;  ///< tets that rounding to nearest by itself would leave flat or inverted
    std::uint64_t repaired = 0; ///< of these, mended by another float near the Steiner point
    std::uint64_t moved_points = 0;

    friend bool operator==(const Rounding&, const Rounding&) = default;
};

/// Makes a tet mesh of raw tets: half-faces from its neighbours, input triangles from its surface faces, the
/// orientation of core/mesh/tet_mesh.h. Steiner points are rounded to float and grid; those on a side of the domain
/// stay in its plane. Where rounding flattens or inverts a tet, floats near its Steiner points are tried; vertices of
/// the input never move. What cannot be mended stays, for find_defect. Throws BuilderFailure{BUILDER_ABSURD_OUTPUT}
/// where an index, a neighbour or a surface face is impossible.
[[nodiscard]] TetMesh convert_tets(const RawTets& output, const TriangleMesh& triangles, const Domain& domain,
                                   Rounding& rounding);

} // namespace tetrace
