#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/rays/aim.h"

#include <vector>

namespace tetrace {

/// A view from the front and above, and three from other sides: rational directions of length 1, from the scene to the
/// camera.
inline constexpr Double3 four_directions[] = {
    {0.36, 0.48, 0.8}, {-0.8, 0.36, -0.48}, {0.64, -0.48, -0.6}, {-0.6, 0.64, 0.48}};

/// The shares of an image that hit the mesh, and that enter its bounding box, of framing_views().
inline constexpr double framed_hits = 0.75, framed_box = 0.97;

/// One view from each of four_directions that the mesh fills. It looks at the centroid of the surface. From 2 radii the
/// camera comes nearer by a tenth of its distance at a time until, in an image of 32 x 32 rays, framed_hits of them hit
/// the mesh and framed_box enter its box. If that does not happen down to a quarter of a radius, it is where most rays
/// hit. Time: linear in the triangles, for each step. Precondition: as bounding_sphere().
[[nodiscard]] std::vector<Aim> framing_views(const TriangleMesh& mesh);

} // namespace tetrace
