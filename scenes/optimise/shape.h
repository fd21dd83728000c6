#pragma once

#include "core/base/vec.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetrace {

/// The least height of a tet that an operation makes, as a part of its longest edge (docs/spec/rays-tets.md, O2).
inline constexpr double min_relative_height = 1e-3;

[[nodiscard]] inline double squared(Double3 a)
{
    return dot(a, a);
}

/// Area of a triangle.
[[nodiscard]] inline double area(Double3 a, Double3 b, Double3 c)
{
    return 0.5 * length(cross(b - a, c - a));
}

/// The least height of a boundary face that an operation makes: more than three times what docs/spec/project.md, P10,
/// asks for, so that no ray sees the face reversed.
inline constexpr double min_boundary_height = 0x1p-12;

/// Whether a boundary face may be made.
[[nodiscard]] inline bool may_be_boundary_face(Double3 a, Double3 b, Double3 c)
{
    const double edge = std::max({squared(b - a), squared(c - b), squared(a - c)});
    return squared(cross(b - a, c - a)) >= min_boundary_height * min_boundary_height * edge;
}

/// A cost that nothing has.
inline constexpr double impossible = std::numeric_limits<double>::infinity();

/// Whether a tet may be made: it is positive (det(b-a, c-a, d-a) < 0, as core/mesh/tet_mesh.h has it) for certain, and
/// no height of it is under min_relative_height. Corners are on the 2^-40 grid and at most 2^6 in magnitude, so that
/// differences are exact in double; a determinant larger than error bound A of ORIENT3D (Shewchuk 1997) has its exact
/// sign. What that bound leaves undecided is refused, so that no answer needs exact arithmetic.
[[nodiscard]] inline bool may_be_made(Double3 a, Double3 b, Double3 c, Double3 d)
{
    const Double3 u = b - a, v = c - a, w = d - a;
    const Double3 vw = cross(v, w);
    const double volume = -dot(u, vw); // six times
    if (!(volume > 0)) return false;
    const double permanent = std::abs(u.x) * (std::abs(v.y * w.z) + std::abs(v.z * w.y)) +
                             std::abs(u.y) * (std::abs(v.z * w.x) + std::abs(v.x * w.z)) +
                             std::abs(u.z) * (std::abs(v.x * w.y) + std::abs(v.y * w.x));
    if (volume <= 7.8e-16 * permanent) return false;
    const Double3 uv = cross(u, v), wu = cross(w, u);
    const double face = std::max({squared(uv), squared(vw), squared(wu), squared(uv + vw + wu)}); // (2 area)^2
    const double edge = std::max({squared(u), squared(v), squared(w), squared(b - c), squared(c - d), squared(d - b)});
    return volume * volume >= min_relative_height * min_relative_height * face * edge;
}

} // namespace tetrace
