#pragma once

#include "core/hit.h"

#include <cstdint>
#include <optional>
#include <span>

namespace tetrace {

/// What became of the rays, counted.
struct RayTotals {
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;
    std::uint64_t misses = 0;
    std::uint64_t lost = 0;
    std::uint64_t unwritten = 0; ///< hit records that still hold POISON
    std::uint64_t hit_steps = 0;
    std::uint64_t miss_steps = 0;
    std::uint64_t lost_steps = 0;

    [[nodiscard]] std::uint64_t steps() const { return hit_steps + miss_steps + lost_steps; }
    void add(const RayTotals& other);
};
[[nodiscard]] RayTotals count_rays(std::span<const Hit> hits);

/// Rays on which two backends disagree.
struct Differences {
    std::uint64_t count = 0;
    std::optional<std::size_t> first; ///< index of the ray
};

/// Compares a backend's hits with openmp's, exact mode: face, tet and steps in every bit; t, u and v within 3 units in
/// the last place. A division is off by 2.5 of them at most (Vulkan and OpenCL promise that) and openmp's by a half.
[[nodiscard]] Differences compare_hits(std::span<const Hit> hits, std::span<const Hit> reference);

} // namespace tetrace
