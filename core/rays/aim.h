#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/rays/camera.h"

#include <string>

namespace tetrace {

/// Where a camera of the user's own is and looks, in radii of the scene's bounding sphere, from its centre.
struct Aim {
    Double3 origin;
    Double3 target = {0, 0, 0};
    Double3 up = {0, 1, 0}; ///< of any length, not along the line of sight

    friend bool operator==(const Aim&, const Aim&) = default;
};

/// Own cameras are within this many radii of the centre: the bounds on rounding are derived for them.
inline constexpr double farthest_aim = 3;

/// Why such a camera is not possible, as the end of a sentence that begins with the name of a member; empty if there is
/// one.
[[nodiscard]] std::string why_no_camera(const Aim& aim);

/// Precondition: why_no_camera() is empty.
[[nodiscard]] Camera aimed_camera(const Aim& aim, const BoundingSphere& sphere);

} // namespace tetrace
