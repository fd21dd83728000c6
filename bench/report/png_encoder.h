#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tetrace {

/// A PNG file's bytes: colour type 2, 8 bits a channel, not interlaced.
/// rgb: 3 width height bytes of sRGB, row after row from the top. Throws Error{internal} if their number differs.
/// Source: Portable Network Graphics (PNG) Specification, W3C, third edition.
[[nodiscard]] std::string png_bytes(std::uint32_t width, std::uint32_t height, std::string_view rgb);

} // namespace tetrace
