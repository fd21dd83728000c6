#pragma once

#include <cstdint>

namespace tetrace::vulkan {

/// Ticks from begin to end of a counter whose low valid_bits (1 to 64) are defined. Correct even if the counter wrapped
/// once in between.
[[nodiscard]] constexpr std::uint64_t ticks_between(std::uint64_t begin, std::uint64_t end, unsigned valid_bits)
{
    const std::uint64_t mask = valid_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << valid_bits) - 1;
    return (end - begin) & mask;
}

} // namespace tetrace::vulkan
