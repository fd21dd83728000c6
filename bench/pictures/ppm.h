#pragma once

#include "bench/pictures/pixmap.h"

#include <filesystem>
#include <string>

namespace tetrace {

/// The picture as a PPM file's bytes (P6, 8 bits of sRGB per channel), which need no library.
/// Source: https://netpbm.sourceforge.net/doc/ppm.html.
[[nodiscard]] std::string ppm_bytes(const Pixmap& pixmap);

/// Writes it to a file. Throws Error{invalid_input} naming the file and the system's reason.
void write_ppm(const std::filesystem::path& path, const Pixmap& pixmap);

} // namespace tetrace
