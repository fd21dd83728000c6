#pragma once

#include "core/mesh/scene.h"

namespace tetrace {

/// The tet that holds a point, by exact orientation tests (a visibility walk; Devillers, Pion, Teillaud 2002).
/// point: coordinates on the 2^-40 grid. Tets are closed: a point on a face, edge or vertex gets any tet that has it.
/// NO_TET where the point is outside the domain.
[[nodiscard]] std::uint32_t locate(const TetMesh& mesh, Float3 point);

/// Where the rays of a view start.
struct Start {
    Float3 origin;              ///< the camera's origin, or a point near it
    std::uint32_t tet = NO_TET; ///< holds the origin in its interior; NO_TET: outside, rays enter by the entry grid
};

/// Locates a camera. A camera nearer than 2^-16 to a face of its tet is within the rounding of a walk's decisions. It
/// moves by at most 2^-12 in each coordinate, to the candidate with the most clearance. All structures trace from the
/// moved origin.
[[nodiscard]] Start find_start(const Scene& scene, Float3 origin);

} // namespace tetrace
