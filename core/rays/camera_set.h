#pragma once

#include "core/base/enum_names.h"
#include "core/mesh/triangle_mesh.h"
#include "core/rays/aim.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

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
