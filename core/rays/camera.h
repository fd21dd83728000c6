#pragma once

#include "core/base/vec.h"

#include <cstdint>

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

} // namespace tetrace
