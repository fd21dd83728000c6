#pragma once

#include "core/base/enum_names.h"
#include "core/mesh/triangle_mesh.h"
#include "core/rays/camera.h"

#include <cstddef>
#include <cstdint>
#include <span>
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

/// Numbered views of a scene, reproducible bit for bit (only + - * / sqrt in IEEE double).
enum class CameraSet {
    frame,  ///< 4 views that the scene fills: its own if the catalogue has some, else framing_views()
    smoke,  ///< 4 views at 2 radii
    orbit,  ///< 1,282 views on a spherical Fibonacci lattice at 2 radii
    flight, ///< 1,282 views along a spiral, distance swept between 1.2 and 2.9 radii
};
template <>
inline constexpr auto enum_names<CameraSet> = names_up_to<CameraSet::flight>("frame", "smoke", "orbit", "flight");

/// The views that a scene's own set has: as many as `frame`.
inline constexpr std::size_t own_view_count = 4;

/// own: the scene's own views, empty or own_view_count; for `frame`.
[[nodiscard]] std::vector<Camera> make_cameras(CameraSet set, const TriangleMesh& mesh, std::span<const Aim> own = {});

/// Of all numbers of all cameras, in their order.
[[nodiscard]] std::uint64_t hash_of_cameras(std::span<const Camera> cameras);

[[nodiscard]] std::size_t view_count(CameraSet set);

} // namespace tetrace
