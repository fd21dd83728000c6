#pragma once

#include "core/base/vec.h"

#include <cstdint>

namespace tetrace {

/// Position along the Hilbert curve through [0,1]^3 at 16 bits per axis; coordinates outside are clamped.
/// Source: Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
[[nodiscard]] std::uint64_t hilbert_index(Double3 unit_point);

} // namespace tetrace
