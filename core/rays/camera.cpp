#include "core/rays/camera.h"

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

} // namespace tetrace
