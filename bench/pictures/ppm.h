#pragma once

#include "bench/pictures/pixmap.h"

#include <string>

namespace tetrace {

/// The picture as a PPM file's bytes (P6, 8 bits of sRGB per channel), which need no library.
/// Source: https://netpbm.sourceforge.net/doc/ppm.html.
[[nodiscard]] std::string ppm_bytes(const Pixmap& pixmap);

} // namespace tetrace
