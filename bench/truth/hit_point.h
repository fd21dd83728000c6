#pragma once

#include "bench/truth/settle.h"
#include "core/rays/hit.h"

#include <cstdint>

namespace tetrace {

/// The factor by which the error of a hit's t, u and v may exceed a decision's bound: 1 + 2 |e1| |e2| |u| /
/// |determinant|. All three are quotients by the same determinant (docs/spec/numbers.md, N3).
[[nodiscard]] double hit_condition(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle);

/// Whether a hit's t, u and v describe one point: origin + t direction equals the barycentric point of its triangle.
/// bound: of a decision, in domain units.
[[nodiscard]] bool names_one_point(const TriangleMesh& mesh, const ExactRay& ray, const Hit& hit, double bound);

} // namespace tetrace
