#pragma once

#include "core/base/vec.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tetrace {

/// Corners up to which a polygon that crosses itself is cut by ears; one with more is cut into a fan.
inline constexpr std::size_t max_crossing_corners = 1000;

/// A polygon's triangles, of its corners' numbers from 0.
struct CutPolygon {
    std::vector<std::array<std::size_t, 3>> triangles;
    bool is_simple = true; ///< else the polygon crosses itself, and the triangles' area is not the polygon's
};

/// Cuts a polygon into triangles of its corners that do not overlap, oriented as it is. It need not be flat: it is
/// projected along the axis on which its area is largest. A fan from its first corner, if all triangles of that have an
/// area; else its constrained Delaunay triangulation, in n log n steps, in which no triangle is without area unless all
/// corners are on a line. Holes joined by an edge that is traversed twice remain holes. The result depends on the
/// corners alone: of cocircular ones, fans from the smallest number are made. A polygon that crosses itself is cut
/// by ears, or into a fan.
[[nodiscard]] CutPolygon cut_polygon(std::span<const Float3> corners);

} // namespace tetrace
