#pragma once

#include "core/base/vec.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <string>

namespace tetrace {

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

[[nodiscard]] View make_view(const Camera& camera, std::uint32_t width, std::uint32_t height);

/// Where a camera of the user's own is and looks, in radii of the scene's bounding sphere, from its centre.
struct Aim {
    Double3 origin;
    Double3 target = {0, 0, 0};
    Double3 up = {0, 1, 0}; ///< of any length, not along the line of sight
};

/// Own cameras are within this many radii of the centre: the bounds on rounding are derived for them.
inline constexpr double farthest_aim = 3;

/// Why such a camera is not possible, as the end of a sentence that begins with the name of a member; empty if there is
/// one.
[[nodiscard]] std::string why_no_camera(const Aim& aim);

/// Precondition: why_no_camera() is empty.
[[nodiscard]] Camera aimed_camera(const Aim& aim, const BoundingSphere& sphere);

} // namespace tetrace
