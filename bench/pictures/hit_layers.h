#pragma once

#include "core/base/vec.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetrace {

/// A ray's hit as a picture file has it. t and steps are those of Hit.
struct HitPixel {
    float t;
    std::uint32_t steps;
    Float3 normal;      ///< of the input triangle, turned towards the viewer, of unit length; 0 without a hit
    std::uint32_t face; ///< a triangle, NO_HIT or LOST

    friend bool operator==(const HitPixel&, const HitPixel&) = default;
};
static_assert(sizeof(HitPixel) == 24 && offsetof(HitPixel, face) == 20,
              "hits cross to the images module as six channels of four bytes");

/// Hits, row after row from the top left.
struct HitLayers {
    std::uint32_t width = 0, height = 0;
    std::vector<HitPixel> pixels;
};

} // namespace tetrace
