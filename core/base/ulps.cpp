#include "core/base/ulps.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tetrace {

std::uint64_t ulps_between(float a, float b)
{
    if (a == b) return 0;
    if (!std::isfinite(a) || !std::isfinite(b) || std::signbit(a) != std::signbit(b))
        return std::numeric_limits<std::uint64_t>::max();
    const std::int64_t distance = std::int64_t{std::bit_cast<std::int32_t>(a)} - std::bit_cast<std::int32_t>(b);
    return static_cast<std::uint64_t>(std::abs(distance));
}

} // namespace tetrace
