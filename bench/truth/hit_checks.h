#pragma once

#include "core/rays/hit.h"

#include <cstdint>
#include <iterator>
#include <optional>
#include <span>

namespace tetrace {

/// Counts of what happened to the rays.
struct RayTotals {
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;
    std::uint64_t misses = 0;
    std::uint64_t lost = 0;
    std::uint64_t unwritten = 0; ///< hit records that still hold POISON
    std::uint64_t hit_steps = 0;
    std::uint64_t miss_steps = 0;
    std::uint64_t lost_steps = 0;
    std::uint64_t reversed = 0; ///< of task segments: Segments::reversed, and the same of length
    std::uint64_t length_units = 0;
    std::uint64_t absorbed = 0; ///< of task absorb: rays that end inside the domain, and the sum of Absorbed::light
    std::uint64_t light_units = 0;

    [[nodiscard]] std::uint64_t steps() const { return hit_steps + miss_steps + lost_steps; }
    void add(const RayTotals& other);
};
/// All of them, in the order in which a journal has them.
inline constexpr std::uint64_t RayTotals::*counts_of_totals[] = {
    &RayTotals::rays,      &RayTotals::hits,         &RayTotals::misses,     &RayTotals::lost,
    &RayTotals::unwritten, &RayTotals::hit_steps,    &RayTotals::miss_steps, &RayTotals::lost_steps,
    &RayTotals::reversed,  &RayTotals::length_units, &RayTotals::absorbed,   &RayTotals::light_units};
static_assert(sizeof(RayTotals) == sizeof(std::uint64_t) * std::size(counts_of_totals));
[[nodiscard]] RayTotals count_rays(std::span<const Hit> hits);
/// The same for answers of task segments: a hit is a ray that crosses the domain, a step a tet that it leaves.
[[nodiscard]] RayTotals count_segments(std::span<const Hit> answers);
/// The same of task absorb.
[[nodiscard]] RayTotals count_absorbed(std::span<const Hit> answers);

/// How far two answers may differ and still count as equal.
struct Allowance {
    std::uint32_t ulps = 0;    ///< of t, u and v, in units in the last place; 0: the same bits
    bool any_triangle = false; ///< any-hit answers: compares whether there is a hit, not which
};

/// Rays on which two backends disagree.
struct Differences {
    std::uint64_t count = 0;          ///< differ by more than allowed
    std::optional<std::size_t> first; ///< index of the first of those
    std::uint64_t inexact = 0;        ///< differ in some bit, allowed or not
    std::uint64_t max_ulps = 0;       ///< of t, u and v where allowed
};

/// Whether two hits count as one answer: the same bits in face, tet and steps, and t, u and v within the allowed
/// distance (see SelfTest::allowed_ulps). Any-hit answers: both hit or both miss.
[[nodiscard]] bool is_same_hit(const Hit& a, const Hit& b, Allowance allowed);

/// Compares a device's hits with openmp's. Throws Error{internal} if the numbers of hits differ.
[[nodiscard]] Differences compare_hits(std::span<const Hit> hits, std::span<const Hit> reference, Allowance allowed);

} // namespace tetrace
