#pragma once

#include "bench/truth/crossings.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tetrace {

/// What the tets' sums must be, bit by bit: each chord of each walk added to its tet (docs/spec/volume.md, S10).
/// rays, tets: how many there are. walk_of: as judge_crossings() has it. threads: 0 is all. Result: by tet, in packed
/// order, in units of 2^-LENGTH_BITS.
[[nodiscard]] std::vector<std::uint64_t> tally_of_walks(std::size_t rays, std::size_t tets,
                                                        const std::function<CrossedTets(std::size_t)>& walk_of,
                                                        unsigned threads);

/// Throws Error{wrong_result} unless the sums of the tets add up to the lengths of the answers, as integers.
void require_total(std::span<const std::uint64_t> tally, std::span<const Hit> answers);

/// Throws Error{wrong_result} with the number of tets whose sums differ, and with the first of them.
void require_sums(std::span<const std::uint64_t> tally, std::span<const std::uint64_t> expected);

/// A tet's share of some rays, computed without any walk, and how far a right tally may be from it.
struct ExactLength {
    double length = 0; ///< in domain units
    double bound = 0;
};

/// What an exact ray, from its origin on, has of a tet between its four planes, in double precision.
struct ExactChord {
    std::uint32_t tet; ///< in the scene's order
    double begin;      ///< distance from the origin
    ExactLength share;
};
/// Of all tets near a ray: looks at each tet, so for small scenes. Shares nothing with the kernels.
[[nodiscard]] std::vector<ExactChord> exact_chords(const Scene& scene, const GivenRay& ray);

/// The exact chords of all rays added up. Result: by tet, in the scene's order.
[[nodiscard]] std::vector<ExactLength> exact_tally(const Scene& scene, const RaySet& set);

} // namespace tetrace
