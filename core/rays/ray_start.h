#pragma once

#include "core/mesh/scene.h"
#include "core/rays/hit.h"
#include "core/rays/ray_set.h"

#include <array>
#include <cstdint>

namespace tetrace {

/// A point moved off the surface that it is on, far enough that a ray from it does not meet the surface again in spite
/// of rounding: by 256 units in the last place of each coordinate, in the direction of a unit normal, and by 2^-16 near
/// zero. For BVHs, whose rays start at a point and not on a face. On the 2^-40 grid.
/// Source: Waechter and Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, 2019,
/// chapter 6.
[[nodiscard]] Float3 offset_point(Float3 point, Float3 normal);

/// The origin of a BVH's ray: offset along the normal of the triangle that the ray starts on, to the side that the ray
/// goes to; unchanged if it starts on no triangle.
[[nodiscard]] Float3 offset_origin(const GivenRay& ray, const TriangleMesh& mesh);

/// Where a ray that leaves a surface starts: a point of the face that was hit, on the side of the tet from which it was
/// hit. The walk enters that tet by that face, so it never tests the face itself and needs no epsilon.
struct RayStart {
    Float3 origin;                  ///< on the face except for rounding; coordinates on the 2^-40 grid
    std::uint32_t half_face;        ///< the tet and its face
    Double3 inward;                 ///< the face's unit normal, into the tet
    std::array<Double3, 3> corners; ///< of the face, counter-clockwise as seen from inside
};

/// Points of a face nearer to an edge than this are moved towards the centre of the face's inscribed circle, until they
/// are far enough or at the centre (docs/spec/given-rays.md, G2). Domain units.
inline constexpr double edge_margin = 0x1p-17;

/// The least sine of the angle between a face and a ray that leaves it.
inline constexpr double min_sine = 0x1p-6;

/// hit: of an input triangle; its tet numbered as in the scene.
/// Throws Error{internal} if the tet lacks a face of that triangle.
[[nodiscard]] RayStart ray_start(const Scene& scene, const Hit& hit);

/// The same without tets: on the triangle that was hit, on the side that a ray of this direction came from; no
/// half-face.
[[nodiscard]] RayStart ray_start(const TriangleMesh& mesh, const Hit& hit, Float3 direction);

/// Whether a ray from there goes into the tet at an angle of at least min_sine, and its line meets the face's plane
/// inside the face, 2^-19 away from its edges: then a walk enters by that face, however it rounds.
[[nodiscard]] bool enters(const RayStart& start, Float3 direction);

/// The face by which the line of a ray from inside a tet enters it, before the origin: a walk that enters by it leaves
/// by the face ahead. If the line passes an edge within rounding, the face that it passes further inside.
[[nodiscard]] std::uint32_t face_behind(const TetMesh& mesh, std::uint32_t tet, Float3 origin, Float3 direction);

} // namespace tetrace
