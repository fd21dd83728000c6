#include "core/rays/camera.h"

#include "core/base/exact.h"

#include <algorithm>

namespace tetrace {

View make_view(const Camera& camera, std::uint32_t width, std::uint32_t height)
{
    constexpr double tan_half_view = 0.57735026918962576; // 30 degrees
    const double pixel = 2 * tan_half_view / std::max(width, height);
    const Double3 step_x = camera.right * pixel;
    const Double3 step_y = camera.up * -pixel;
    const Double3 corner = camera.forward - step_x * (0.5 * (width - 1.0)) - step_y * (0.5 * (height - 1.0));
    return {camera.origin, to_float(corner), to_float(step_x), to_float(step_y)};
}

namespace {

/// The sine of the least angle between the line of sight and up: about a thousandth of a degree.
constexpr double min_sine_of_up = 0x1p-16;
/// Between origin and target, in radii: nearer ones leave no digits of the direction.
constexpr double min_sight = 0x1p-16;

} // namespace

std::string why_no_camera(const Aim& aim)
{
    const Double3 sight = aim.target - aim.origin;
    if (!(length(aim.origin) <= farthest_aim)) return "origin: is more than 3 radii from the scene's centre";
    if (!(length(aim.target) <= 1e6)) return "target: is more than 1,000,000 radii from the scene's centre";
    if (!(length(sight) >= min_sight)) return "target: is where the origin is";
    const double size = length(aim.up);
    if (!(size >= 1e-6 && size <= 1e6)) return "up: has a length below 0.000001 or above 1,000,000";
    if (!(length(cross(normalized(sight), normalized(aim.up))) >= min_sine_of_up))
        return "up: is along the line of sight";
    return {};
}

Camera aimed_camera(const Aim& aim, const BoundingSphere& sphere)
{
    const auto placed = [&](Double3 point) { return sphere.centre + point * sphere.radius; };
    Camera camera;
    camera.origin = snap_to_grid(to_float(placed(aim.origin)));
    camera.forward = normalized(placed(aim.target) - to_double(camera.origin));
    camera.right = normalized(cross(camera.forward, aim.up));
    camera.up = cross(camera.right, camera.forward);
    return camera;
}

} // namespace tetrace
