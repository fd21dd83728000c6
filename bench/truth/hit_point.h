#pragma once

#include "bench/truth/settle.h"
#include "core/rays/hit.h"

#include <cstdint>

namespace tetrace {

/// How much farther than a decision's bound the t, u and v of a hit may be off: 1 + 2 |e1| |e2| |u| / |determinant|,
/// for all three are quotients by the same determinant (docs/spec/numbers.md, N3).
[[nodiscard]] double hit_condition(const TriangleMesh& mesh, const ExactRay& ray, std::uint32_t triangle);

/// Whether a hit's t, u and v name one point: origin + t direction, and the barycentric point of its triangle.
/// bound: of a decision, in domain units.
[[nodiscard]] bool names_one_point(const TriangleMesh& mesh, const ExactRay& ray, const Hit& hit, double bound);

} // namespace tetrace
