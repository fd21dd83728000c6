#pragma once

#include "core/scene.h"

#include <cstdint>

namespace tetrace {

/// The conformance scene that needs no TetGen: a jittered grid of resolution^3 cubes, each cut into six tets, filling
/// its domain; the faces between cubes inside and outside a ball are occlusive. Reproducible bit for bit.
/// resolution: 2 to 128 cubes along an axis, else throws Error{usage}. The domain's divisions equal it. The ball's
/// surface is closed from 3 on; at 2 it is that of one corner cube, open towards the domain's boundary.
[[nodiscard]] Scene make_cubes(std::uint32_t resolution);

/// A curved, tapering, capped tube in mesh units: so many triangles or a few less, closed, the same bits everywhere.
/// With 25,000 its CDT with the default switches keeps them whole and has about 71,000 tets, the size of the paper's
/// smallest scene (Table 3's banana). triangles: least_banana to most_banana (scenes/catalogue.h), else throws
/// Error{usage}.
[[nodiscard]] TriangleMesh make_banana(std::uint32_t triangles = 25'000);

} // namespace tetrace
