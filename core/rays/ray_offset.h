#pragma once

#include "core/rays/ray_set.h"

namespace tetrace {

/// A point moved off the surface that it is on, far enough that a ray from there meets the surface no more, though both
/// are rounded: by 256 units in the last place of each coordinate, in the direction of a unit normal, and by 2^-16 near
/// zero. For BVHs, which know no start but a point. On the 2^-40 grid.
/// Source: Waechter and Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, 2019,
/// chapter 6.
[[nodiscard]] Float3 offset_point(Float3 point, Float3 normal);

/// The origin that a BVH's ray starts from: offset along the normal of the triangle that the ray starts on, to the side
/// that it goes to; its own where it starts on none.
[[nodiscard]] Float3 offset_origin(const GivenRay& ray, const TriangleMesh& mesh);

} // namespace tetrace
