#pragma once

#include "bench/report/html/html.h"

#include <cstdint>
#include <filesystem>

namespace tetrace {

/// A PNG file's bytes, and the size that they say.
struct Png {
    std::string bytes;
    std::uint32_t width = 0, height = 0;
};

/// A PNG file as it is; a PPM file (P6, 255 levels, no comments: what machines without OpenImageIO write) as PNG.
/// Throws Error{missing} for a file that is not there, Error{invalid_input} for one that is neither, or larger than
/// 64 MiB.
[[nodiscard]] Png read_picture(const std::filesystem::path& path);

/// The picture in the page itself, its file's name under it. Throws as read_picture() does.
[[nodiscard]] Html picture_figure(const std::filesystem::path& path);

/// The same for a picture that a result names, relative to the folder that the result lies in; where read_picture()
/// would throw, a note that says why the picture is not shown: results travel without their pictures.
[[nodiscard]] Html named_picture(const std::filesystem::path& folder, const std::string& name);

} // namespace tetrace
