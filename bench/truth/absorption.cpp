#include "bench/truth/absorption.h"

#include <algorithm>
#include <array>

namespace tetrace {

Medium medium_of(std::uint32_t tet)
{
    std::uint32_t word = (tet + 1) * 0x9E3779B1u;
    word = (word ^ word >> 15u) * 0x85EBCA6Bu;
    return {word >> 24u, word >> 16u & 255u};
}

std::uint32_t transmittance_at(std::uint64_t depth)
{
    constexpr std::array<std::uint64_t, 6> coefficients = {0x78809,   0x54A612,   0x274F388,
                                                           0xE353290, 0x3D7F7506, 0xB17217DF};
    const std::uint64_t halvings = depth >> 32u, fraction = (depth & 0xFFFFFFFF) >> 8u << 8u;
    if (halvings > TRANSMITTANCE_BITS) return 0;
    std::uint64_t rest = 0;
    for (const std::uint64_t coefficient : coefficients)
        rest = coefficient - (fraction * rest >> 32u);
    const std::uint64_t power = (std::uint64_t{1} << 31u) - (fraction * rest >> 33u);
    return static_cast<std::uint32_t>(power >> (31 - TRANSMITTANCE_BITS + halvings));
}

Absorbed absorption_of(const CrossedTets& walk)
{
    CrossedTets lit;
    lit.places.assign(walk.places.begin(), walk.places.begin() + (walk.tets.empty() ? 0 : 1));
    std::uint64_t depth = 0;
    std::uint32_t passed = NO_ABSORPTION, light = 0, farthest = walk.tets.empty() ? 0 : walk.places.front();
    for (std::size_t i = 0; i < walk.tets.size() && passed >= MIN_TRANSMITTANCE; ++i) {
        const Medium medium = medium_of(walk.tets[i]);
        const std::uint32_t next = std::max(farthest, walk.places.at(i + 1));
        depth += std::uint64_t{medium.density} * (next - farthest);
        const std::uint32_t left = transmittance_at(depth);
        light += medium.value * (passed - left);
        passed = left;
        farthest = next;
        lit.tets.push_back(walk.tets[i]);
        lit.places.push_back(walk.places[i + 1]);
    }
    const Segments sum = summary_of(lit);
    return {sum.first, sum.last, light, sum.hash, passed, sum.crossings};
}

} // namespace tetrace
