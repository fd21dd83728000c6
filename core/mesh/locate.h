#pragma once

#include "core/mesh/scene.h"

namespace tetrace {

/// The tet that holds a point, by exact orientation tests (a visibility walk; Devillers, Pion, Teillaud 2002).
/// point: coordinates on the 2^-40 grid. The tet is closed: on a face, edge or vertex, any tet that has it.
/// NO_TET where the point is outside the domain.
[[nodiscard]] std::uint32_t locate(const TetMesh& mesh, Float3 point);

/// Where the rays of a view start.
struct Start {
    Float3 origin;              ///< the camera's origin, or the point next to it that rays start from
    std::uint32_t tet = NO_TET; ///< holds the origin in its interior; NO_TET: outside, rays enter by the entry grid
};

/// Locates a camera. One that is nearer than 2^-16 to a face of its tet (on a face, an edge or a vertex, say) is within
/// the rounding of a walk's decisions: it moves by at most 2^-12 in each coordinate to a place with more clearance, the
/// best of a few candidates. Every structure then traces from the same moved origin.
[[nodiscard]] Start find_start(const Scene& scene, Float3 origin);

} // namespace tetrace
