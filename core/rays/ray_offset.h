#pragma once

#include "core/pack/packed_scene.h"
#include "core/rays/ray_set.h"

#include <vector>

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

/// The rays as Session::set_rays wants them: GIVEN_RAY_QUADS a ray (kernels/layouts/layout.h).
/// packed: tets of the set's scene; links are numbered as it is.
/// Throws Error{internal} where a link names none of its tets.
[[nodiscard]] std::vector<Quad> given_quads(const RaySet& set, const PackedScene& packed);

/// The same for a BVH: origins offset, no links.
[[nodiscard]] std::vector<Quad> given_quads_offset(const RaySet& set, const TriangleMesh& mesh);

} // namespace tetrace
