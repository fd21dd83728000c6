#pragma once

#include "bench/options/options.h"
#include "core/mesh/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// A ray as files have it: origin, t_min, direction, t_max; in the mesh's coordinates.
using RayNumbers = std::array<float, 8>;

/// Rays for programs that trace a mesh, the same on every machine:
/// - primary: of the pixels of four square images, those of camera set `frame`;
/// - random: isotropic uniform lines through the mesh's bounding sphere, from outside it;
/// - hard: through vertices and edges, along edges, in the planes of faces, from vertices and faces, at grazing angles,
/// in the thinnest triangles, and with an end on the mesh. Many pass exactly through a vertex or an edge.
/// Precondition: the mesh has a triangle. Throws Error{invalid_input} if it is too small for them.
[[nodiscard]] std::vector<RayNumbers> make_mesh_rays(MadeRays kind, const TriangleMesh& mesh, std::uint64_t count);

} // namespace tetrace
