#pragma once

#include "core/rays/ray_set.h"

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

} // namespace tetrace
