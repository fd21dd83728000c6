#pragma once

#include "core/rays/hit.h"

#include <bit>

namespace tetrace {

/// One ray's answer in task absorb: the light of a medium that reaches its beginning. It has the size of a hit, and
/// travels as one.
struct Absorbed {
    std::uint32_t first;         ///< tet, in packed order; NO_HIT if the ray crosses none; LOST, POISON
    std::uint32_t last;          ///< tet that it leaves; NO_TET if there is none
    std::uint32_t light;         ///< in units of 2^-(8 + TRANSMITTANCE_BITS)
    std::uint32_t hash;          ///< of the tets, as Segments has it
    std::uint32_t transmittance; ///< of all tets together, in units of 2^-TRANSMITTANCE_BITS
    std::uint32_t crossings;     ///< tets left

    friend bool operator==(const Absorbed&, const Absorbed&) = default;
};
static_assert(sizeof(Absorbed) == sizeof(Hit), "a ray's answer is HIT_WORDS words in every task but search");

[[nodiscard]] inline Absorbed absorbed_of(const Hit& answer)
{
    return std::bit_cast<Absorbed>(answer);
}
[[nodiscard]] inline Hit as_hit(const Absorbed& absorbed)
{
    return std::bit_cast<Hit>(absorbed);
}

/// Of all light, 0 to 1.
[[nodiscard]] inline double share_of_light(std::uint64_t units)
{
    return static_cast<double>(units) / (256.0 * (1u << TRANSMITTANCE_BITS));
}
/// The same of what passes.
[[nodiscard]] inline double share_passed(std::uint32_t transmittance)
{
    return static_cast<double>(transmittance) / (1u << TRANSMITTANCE_BITS);
}

} // namespace tetrace
