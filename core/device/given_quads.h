#pragma once

#include "core/pack/packed_scene.h"
#include "core/rays/ray_set.h"

#include <vector>

namespace tetrace {

/// The rays in the form of Session::set_rays: GIVEN_RAY_QUADS per ray (kernels/layouts/layout.h).
/// packed: tets of the set's scene; the half-faces in the result are numbered in its order.
/// Throws Error{internal} if a half-face names none of its tets.
[[nodiscard]] std::vector<Quad> given_quads(const RaySet& set, const PackedScene& packed);

/// The same for task segments: each with its ray's stretch in place of its end. Precondition: no ray has an end.
[[nodiscard]] std::vector<Quad> segment_quads(const RaySet& set, const PackedScene& packed);

/// 2^STRETCH_BITS times a direction's length over the magnitude of its largest component, rounded to nearest.
[[nodiscard]] std::uint32_t stretch_of(Float3 direction);

/// As given_quads(), but for a BVH: origins are offset, without half-faces.
[[nodiscard]] std::vector<Quad> given_quads_offset(const RaySet& set, const TriangleMesh& mesh);

} // namespace tetrace
