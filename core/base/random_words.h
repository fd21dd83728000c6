#pragma once

#include "core/base/vec.h"

#include <array>
#include <cstdint>

namespace tetrace {

/// Four random words, a function of their place and stream alone, the same on every machine: Philox 4x32-10 (Salmon,
/// Moraes, Dror, Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011).
using RandomWords = std::array<std::uint32_t, 4>;
[[nodiscard]] RandomWords random_words(const RandomWords& place, std::uint32_t stream);

/// Where a random number of a ray is drawn.
struct RandomPlace {
    std::uint32_t stream; ///< what it is for
    std::uint32_t view, pixel, dimension;
};

/// A point of the unit sphere, uniformly: one of its ball, drawn until it lies in it, no nearer to the centre than 1/16
/// and moved out. Only + - * / sqrt in IEEE double: sines differ between machines.
[[nodiscard]] Double3 random_direction(const RandomPlace& place);

} // namespace tetrace
