#pragma once

#include "core/rays/hit.h"

#include <bit>

namespace tetrace {

/// One ray's answer in task segments: what it crosses. It has the size of a hit, and travels as one.
struct Segments {
    std::uint32_t first;     ///< tet, in packed order; NO_HIT if the ray crosses none; LOST, POISON
    std::uint32_t last;      ///< tet; NO_TET if there is none
    std::uint32_t length;    ///< of all segments, in units of 2^-LENGTH_BITS
    std::uint32_t hash;      ///< of the tets in order, each with the place where it is left
    std::uint32_t reversed;  ///< faces whose place is before that of a face met earlier
    std::uint32_t crossings; ///< tets left

    friend bool operator==(const Segments&, const Segments&) = default;
};
static_assert(sizeof(Segments) == sizeof(Hit), "a ray's answer is HIT_WORDS words in every task but search");

/// first is where a hit's face_id is, last where its tet is, crossings where its steps are.
[[nodiscard]] inline Segments segments_of(const Hit& answer)
{
    return std::bit_cast<Segments>(answer);
}
[[nodiscard]] inline Hit as_hit(const Segments& segments)
{
    return std::bit_cast<Hit>(segments);
}

/// Length of a segment, or of several, in domain units.
[[nodiscard]] inline double length_of(std::uint64_t units)
{
    return static_cast<double>(units) * (1.0 / (1u << LENGTH_BITS));
}

} // namespace tetrace
