#pragma once

#include "core/base/vec.h"

#include <compare>
#include <cstdint>

namespace tetrace {

/// Every coordinate that a ray can meet is a multiple of this, and at most 2^6 in magnitude: decisions of the walk then
/// never produce a denormal (docs/spec/numbers.md, N1), and exact arithmetic fits fixed-width integers.
inline constexpr double coordinate_grid = 0x1p-40;

/// Rounds to the grid; the identity for every float of magnitude 2^-16 or more.
[[nodiscard]] float snap_to_grid(float coordinate);
[[nodiscard]] Float3 snap_to_grid(Float3 point);

/// Sign of det(b-a, c-a, d-a), exact. Precondition: coordinates on the grid.
[[nodiscard]] int orientation(Float3 a, Float3 b, Float3 c, Float3 d);

/// Where an exact ray meets an exact triangle.
struct ExactCrossing {
    bool met = false; ///< the closed triangle is met at t >= 0; never for a ray in the triangle's plane
    double t = 0;     ///< rounded to nearest only at the end; for messages
    /// Signs of the ray's position with respect to the edges v0v1, v1v2, v2v0; all >= 0 or all <= 0 if the line
    /// meets it.
    int edge_side[3] = {0, 0, 0};
};
[[nodiscard]] ExactCrossing cross_exactly(Float3 origin, Float3 direction, Float3 v0, Float3 v1, Float3 v2);

/// Compares the exact ray parameters at the planes of two triangles that the ray meets.
[[nodiscard]] std::strong_ordering compare_distance(Float3 origin, Float3 direction, const Float3 (&a)[3],
                                                    const Float3 (&b)[3]);

/// Largest distance between a ray and an edge at which float32 may decide the edge either way:
/// 10 ulp(1/2) (|origin| + sqrt 3), derived for the side products of `maria` in docs/spec/numbers.md, N2. Domain units.
[[nodiscard]] double tie_bound(Float3 origin);

/// Units in the last place between two floats; huge where their signs differ or one is not finite.
[[nodiscard]] std::uint64_t ulps_between(float a, float b);

} // namespace tetrace
