#pragma once

#include <array>
#include <cstdint>

namespace tetrace {

/// Corners of a tet's faces, as in kernels/layouts/faces.h: counter-clockwise as seen from inside the tet.
inline constexpr std::array<std::array<std::uint32_t, 3>, 4> face_corners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

} // namespace tetrace
