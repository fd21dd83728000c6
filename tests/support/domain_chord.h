#pragma once

#include "core/base/exact.h"
#include "core/mesh/domain.h"
#include "core/rays/ray_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tetrace::test {

/// How far a ray goes in the domain's box, from its origin on. Empty if it misses the box, or runs nearly along a side:
/// such a side is met farther off within rounding.
inline std::optional<double> chord_of_domain(const Domain& domain, const GivenRay& ray)
{
    const Double3 low = to_double(domain.low()), high = to_double(domain.high());
    const Double3 o = to_double(ray.origin), u = to_double(ray.direction);
    double begin = 0, end = HUGE_VAL, steep = 1;
    for (const auto [from, along, least, most] :
         {std::array{o.x, u.x, low.x, high.x}, std::array{o.y, u.y, low.y, high.y},
          std::array{o.z, u.z, low.z, high.z}}) {
        if (along == 0) {
            if (from <= least || from >= most) begin = HUGE_VAL; // in the plane of a side it misses (D4)
            continue;
        }
        steep = std::min(steep, std::abs(along) / length(u));
        begin = std::max(begin, std::min((least - from) / along, (most - from) / along));
        end = std::min(end, std::max((least - from) / along, (most - from) / along));
    }
    if (steep < 0.25 || begin >= end) return std::nullopt;
    return (end - begin) * length(u);
}

} // namespace tetrace::test
