#pragma once

#include <cstdint>

namespace tetrace {

/// A number that depends on nothing but its counter (the finaliser of MurmurHash3).
[[nodiscard]] constexpr std::uint32_t scramble(std::uint32_t counter)
{
    counter ^= counter >> 16;
    counter *= 0x85EBCA6Bu;
    counter ^= counter >> 13;
    counter *= 0xC2B2AE35u;
    return counter ^ counter >> 16;
}

} // namespace tetrace
