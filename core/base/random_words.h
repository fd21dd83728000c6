#pragma once

#include "core/base/vec.h"

#include <array>
#include <cstdint>

namespace tetrace {

/// Four random words, a function of only place and stream, the same on every machine: Philox 4x32-10 (Salmon,
/// Moraes, Dror, Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011).
using RandomWords = std::array<std::uint32_t, 4>;
[[nodiscard]] RandomWords random_words(const RandomWords& place, std::uint32_t stream);

/// Where a random number of a ray is drawn.
struct RandomPlace {
    std::uint32_t stream; ///< its purpose
    std::uint32_t view, pixel, dimension;
};

/// A uniform point of the unit sphere: points of the cube are drawn until one is in the ball, at least 1/16 from the
/// centre; it is projected onto the sphere. Only + - * / sqrt in IEEE double: sines differ between machines.
[[nodiscard]] Double3 random_direction(const RandomPlace& place);

} // namespace tetrace
