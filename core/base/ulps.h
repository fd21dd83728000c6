#pragma once

#include <cstdint>

namespace tetrace {

/// Units in the last place between two floats; huge where their signs differ or one is not finite.
[[nodiscard]] std::uint64_t ulps_between(float a, float b);

} // namespace tetrace
