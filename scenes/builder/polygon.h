#pragma once

#include "core/base/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// Corners up to which polygons that are not convex are cut without overlap; those with more are cut into fans.
inline constexpr std::size_t max_concave_corners = 1000;

/// Cuts a polygon into triangles of its corners (numbers from 0), turned as it is: a fan from its first corner where
/// that does not overlap, else by ears. Flatness is not asked for: it is seen along its mean normal. A polygon that
/// crosses itself has triangles that do.
[[nodiscard]] std::vector<std::array<std::size_t, 3>> cut_polygon(std::span<const Float3> corners);

} // namespace tetrace
