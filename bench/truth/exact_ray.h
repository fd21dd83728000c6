#pragma once

#include "core/base/vec.h"
#include "core/rays/hit.h"

#include <cstdint>

namespace tetrace {

/// A ray for exact arithmetic: its float coordinates, taken literally.
struct ExactRay {
    Float3 origin, direction;
};

/// Which part of a ray counts, and which answer is wanted.
struct RayPart {
    std::uint32_t start = NO_HIT; ///< the triangle that it starts on and does not meet again; NO_HIT: none
    float end = NO_END;           ///< ray parameter of its end
    bool any_hit = false;         ///< the answer need not be nearest

    [[nodiscard]] bool has_end() const { return end < NO_END; }
};

} // namespace tetrace
