#pragma once

#include "bench/pictures/pixmap.h"

#include <cstdint>
#include <string_view>

namespace tetrace {

/// Pixels from one letter to the next, and from one line to the next, at scale 1.
inline constexpr std::uint32_t letter_width = 6, letter_height = 9;

/// Draws text with its top left corner at (x, y), each dot of a letter scale x scale pixels; what is outside the
/// picture is cut off. Lower-case letters, digits and .,:;-_+/()%=<> are drawn; capitals as lower case, the rest as a
/// box.
void draw_text(Pixmap& pixmap, std::int64_t x, std::int64_t y, std::string_view text, Colour colour,
               std::uint32_t scale = 1);

} // namespace tetrace
