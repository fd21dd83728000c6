#pragma once

#include "core/mesh/scene.h"
#include "core/rays/hit.h"

#include <array>
#include <cstdint>

namespace tetrace {

/// Where a ray starts that leaves a surface: a point of the face that was hit, on the side of the tet it was hit from.
/// A walk is told that it enters that tet by that face, so that it never asks for the face itself and needs no epsilon.
struct RayStart {
    Float3 origin;                  ///< on the face but for rounding; coordinates on the 2^-40 grid
    std::uint32_t link;             ///< the tet and its face
    Double3 inward;                 ///< the face's unit normal, into the tet
    std::array<Double3, 3> corners; ///< of the face, counter-clockwise as seen from inside
};

/// Points of a face nearer to an edge than this are moved towards the centre of its inscribed circle until they are
/// not, or are that centre (docs/spec/given-rays.md, G2). Domain units.
inline constexpr double edge_margin = 0x1p-17;

/// Rays leave a face no flatter than this: the least sine of the angle between direction and face.
inline constexpr double least_sine = 0x1p-6;

/// hit: of an input triangle; its tet numbered as in the scene.
/// Throws Error{internal} where the tet has no face of that triangle.
[[nodiscard]] RayStart ray_start(const Scene& scene, const Hit& hit);

/// Whether a ray from there goes into the tet, no flatter than least_sine, and its line meets the face's plane in the
/// face, 2^-19 away from its edges: whichever way a walk rounds, it enters by that face.
[[nodiscard]] bool enters(const RayStart& start, Float3 direction);

/// The face by which the line of a ray from inside a tet enters it, behind the origin: a walk that is told to enter by
/// it leaves by the face ahead. Where the line passes an edge within rounding, that it passes further inside.
[[nodiscard]] std::uint32_t face_behind(const TetMesh& mesh, std::uint32_t tet, Float3 origin, Float3 direction);

} // namespace tetrace
