#pragma once

#include "core/rays/hit.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A ray with a wrong answer, and everything needed to examine it.
struct WrongRay {
    std::uint32_t view = 0, x = 0, y = 0;
    Hit ours{};
    std::uint32_t reference_face = NO_HIT;
    float reference_t = 0;
    std::string reason;
};

/// Verdicts on the rays of an image; each ray is in exactly one of agreed, ties, settled, offset, wrong, lost.
struct Verdicts {
    std::uint64_t rays = 0;
    std::uint64_t agreed = 0;  ///< the exact ray's answer, and no edge or other triangle is within tie_bound() of it
    std::uint64_t settled = 0; ///< the exact ray's answer, although some do
    std::uint64_t ties = 0;    ///< another answer, that of a curve within tie_bound() of the ray: its witness
    std::uint64_t offset = 0;  ///< of given rays: right only for the offset origin that a BVH starts from
    std::uint64_t wrong = 0;
    std::uint64_t lost = 0;
    double max_tie_distance = 0;         ///< in domain units, of all ties' witnesses from their rays
    std::optional<WrongRay> first_wrong; ///< the first wrong or lost ray
    std::vector<std::uint32_t> flawed;   ///< of one image: pixels (y * width + x) of its wrong and lost rays, ascending

    /// Adds the counts; leaves `flawed` unchanged, because pixels of different images cannot be merged.
    void add(const Verdicts& other);
    [[nodiscard]] bool clean() const { return wrong == 0 && lost == 0; }
};

} // namespace tetrace
