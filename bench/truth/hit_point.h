#pragma once

#include "bench/truth/exact_ray.h"
#include "core/base/vec.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>

namespace tetrace {

/// Where a ray's line meets a triangle's plane, and by how much the kernels' float32 formula may be off
/// (docs/spec/numbers.md, N3). All numbers are infinite where rounding may make that formula's determinant zero.
struct HitPoint {
    double t = 0, u = 0, v = 0;
    double t_error = 0, u_error = 0, v_error = 0;
    bool may_be_edge_on = false; ///< the formula may take the triangle for one that is seen edge-on
};
[[nodiscard]] HitPoint point_of(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle);

/// The same of any line, and of that formula in another precision. unit_roundoff: 2^-24 for float32.
[[nodiscard]] HitPoint point_of(const TriangleMesh& mesh, Double3 origin, Double3 direction, std::uint32_t triangle,
                                double unit_roundoff);

/// How far past a ray's end, or before it, a triangle may be met and count as on the other side: the error of t, and
/// the bound.
[[nodiscard]] double end_error_of(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle, double bound);

/// Whose formula computed a hit's t, u and v.
enum class HitFormula {
    kernels, ///< make_hit() of kernels/hit.h
    other,   ///< that of Embree or of a driver, which is not ours to know
};

/// Whether a hit's t, u and v are right.
/// By the kernels' formula: each is within its error of the exact one. Or the triangle may count as seen edge-on, the
/// point is in the triangle, and t between the depths of its vertices.
/// By another formula: origin + t direction is the barycentric point of the triangle, up to bound (1 + 2 |e1| |e2| |u|
/// / |determinant|). bound: of a decision, in domain units.
[[nodiscard]] bool names_right_point(const TriangleMesh& mesh, const ExactRay& ray, const Hit& hit, HitFormula formula,
                                     double bound);

} // namespace tetrace
