#pragma once

#include "kernels/layouts/layout.h"

#include <cstddef>
#include <cstdint>

namespace tetrace {

/// One ray's answer, byte for byte the same on every backend.
struct Hit {
    std::uint32_t face_id; ///< input triangle, or NO_HIT, LOST, POISON
    std::uint32_t tet;     ///< last tet of the walk, in packed order; NO_TET if there was none
    float t;               ///< ray parameter: origin + t * direction; 0 on a miss
    float u, v;            ///< barycentric coordinates of the second and third vertex; 0 on a miss
    std::uint32_t steps;   ///< tets left

    friend bool operator==(const Hit&, const Hit&) = default;
};
static_assert(sizeof(Hit) == 24 && offsetof(Hit, t) == 8, "every backend reads Hit; see kernels/layouts/layout.h");

} // namespace tetrace
