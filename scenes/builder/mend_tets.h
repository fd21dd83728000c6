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

/// What rounding Steiner points to float did.
struct Rounding {
    std::uint64_t damaged = 0;  ///< tets that rounding to nearest by itself would leave flat or inverted
    std::uint64_t repaired = 0; ///< how many fewer there are once tets and Steiner points were changed
    std::uint64_t moved_points = 0;
    std::uint64_t removed_points = 0;
    std::uint64_t refilled = 0; ///< cavities that got other tets

    friend bool operator==(const Rounding&, const Rounding&) = default;
};

/// Mends flat and inverted tets. First it tries floats near each of their vertices that may move, nearest first, and
/// keeps one that leaves fewer bad tets around it. If that does not help, it puts the vertex onto a neighbour, and
/// the tets between them vanish: one on an input triangle goes along it, one on an edge of input triangles along that
/// edge, and one whose freedom lacks an axis stays. Else it puts other tets in the place of those around the vertex or
/// the tet. Deterministic; vertices without freedom never move or go. mesh: half-faces and faces are sound. Vertices
/// keep their numbers, and some may be of no tet. tests: how many tests of a tet the moves may take, and as many again
/// the removals; the default takes a second or two of each. Cavities have a bound of their own.
Rounding mend_tets(TetMesh& mesh, const std::vector<Freedom>& freedom, std::uint64_t tests = 20'000'000);

} // namespace tetrace
