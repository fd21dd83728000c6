#pragma once

#include "bench/report/html/html.h"

#include <cstdint>
#include <filesystem>

namespace tetrace {

/// A PNG file's bytes, and the size from its header.
struct Png {
    std::string bytes;
    std::uint32_t width = 0, height = 0;
};

/// In the format of zlib (RFC 1950).
[[nodiscard]] std::string deflated(const std::string& plain);

/// A PNG file unchanged; a PPM file (P6, 255 levels, no comments: written on machines without OpenImageIO) converted to
/// PNG.
/// Throws Error{missing} for a missing file, Error{invalid_input} for one that is neither, or larger than 64 MiB.
[[nodiscard]] Png read_picture(const std::filesystem::path& path);

/// The picture embedded in the page, with its file name below. Throws as read_picture() does.
[[nodiscard]] Html picture_figure(const std::filesystem::path& path);

/// The same for a picture that a result names, relative to the result's folder. Where read_picture() would throw,
/// returns a note that says why the picture is not shown: results may be copied without their pictures.
[[nodiscard]] Html named_picture(const std::filesystem::path& folder, const std::string& name);

} // namespace tetrace
