#pragma once

#include "core/scene.h"

#include <cstdint>

namespace tetrace {

/// The conformance scene that needs no TetGen: a jittered grid of resolution^3 cubes, each cut into six tets, filling
/// its domain; the faces between cubes inside and outside a ball are occlusive. Reproducible bit for bit.
/// resolution: 2 to 128 cubes along an axis. The domain's divisions equal it.
[[nodiscard]] Scene make_cubes(std::uint32_t resolution);

/// A curved, tapering, capped tube in mesh units, about 7,700 triangles; its CDT with the default switches is the
/// smallest scene of the paper's kind (Table 3's banana).
[[nodiscard]] TriangleMesh make_banana();

} // namespace tetrace
