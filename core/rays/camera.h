#pragma once

#include "core/base/enum_names.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// Numbered views around a scene, reproducible bit for bit (only + - * / sqrt in IEEE double).
enum class CameraSet {
    smoke,  ///< 4 views at 2 radii
    orbit,  ///< 1,282 views on a spherical Fibonacci lattice at 2 radii
    flight, ///< 1,282 views along a spiral, distance swept between 1.2 and 2.9 radii
};
template <>
inline constexpr auto enum_names<CameraSet> = names_up_to<CameraSet::flight>("smoke", "orbit", "flight");

/// A pinhole camera, 60 degrees field of view along the image's larger side.
struct Camera {
    Float3 origin;              ///< a multiple of 2^-40 per coordinate, so that no intermediate product is denormal
    Double3 forward, right, up; ///< orthonormal
};

/// The parameters of a camera at a given image size. The direction of pixel (x, y) is corner + step_x * x + step_y * y,
/// through the pixel's centre; (0, 0) is the top left. Directions are not normalized: t is the distance along the
/// optical axis.
struct View {
    Float3 origin, corner, step_x, step_y;

    friend bool operator==(const View&, const View&) = default;
};

[[nodiscard]] std::vector<Camera> make_cameras(CameraSet set, const BoundingSphere& sphere);
[[nodiscard]] View make_view(const Camera& camera, std::uint32_t width, std::uint32_t height);

[[nodiscard]] std::size_t view_count(CameraSet set);

} // namespace tetrace
