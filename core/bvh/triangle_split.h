#pragma once

#include "core/mesh/box.h"

namespace tetrace {

/// The boxes of a triangle's two parts.
struct TriangleParts {
    Box below, above;
};

/// Cuts a triangle at a plane across an axis. Returns the boxes of the parts on either side that lie in `box`, rounded
/// outwards; empty if that part is empty. What is in the plane is in both.
[[nodiscard]] TriangleParts split_triangle(const Float3 (&corners)[3], int axis, float position, const Box& box);

} // namespace tetrace
