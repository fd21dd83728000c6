#pragma once

#include "core/pack/packed_scene.h"
#include "core/rays/ray_set.h"

#include <vector>

namespace tetrace {

/// The rays as Session::set_rays wants them: GIVEN_RAY_QUADS a ray (kernels/layouts/layout.h).
/// packed: tets of the set's scene; links are numbered as it is.
/// Throws Error{internal} where a link names none of its tets.
[[nodiscard]] std::vector<Quad> given_quads(const RaySet& set, const PackedScene& packed);

/// The same for a BVH: origins offset, no links.
[[nodiscard]] std::vector<Quad> given_quads_offset(const RaySet& set, const TriangleMesh& mesh);

} // namespace tetrace
