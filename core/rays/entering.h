#pragma once

#include "core/mesh/domain.h"
#include "core/rays/ray_set.h"

#include <cmath>
#include <cstdint>
#include <span>

namespace tetrace {

/// Whether a ray has a point inside the domain's box before its end: a slab test in double, which knows nothing of the
/// tets. A ray that only touches the box does not enter it; one that starts inside does.
[[nodiscard]] bool enters(const Domain& domain, Double3 origin, Double3 direction, double end = HUGE_VAL);

/// The number of a view's primary rays, one per pixel, that enter the domain.
[[nodiscard]] std::uint64_t count_entering(const Domain& domain, const View& view, std::uint32_t width,
                                           std::uint32_t height);

/// The same of given rays.
[[nodiscard]] std::uint64_t count_entering(const Domain& domain, std::span<const GivenRay> rays);

} // namespace tetrace
