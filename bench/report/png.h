#pragma once

#include "bench/report/html.h"

#include <cstdint>
#include <filesystem>

namespace tetrace {

/// A PNG file as it is.
struct Png {
    std::string bytes;
    std::uint32_t width = 0, height = 0;
};

/// Throws Error{missing} for a file that is not there, Error{invalid_input} for one that is no PNG, or larger than
/// 64 MiB.
[[nodiscard]] Png read_png(const std::filesystem::path& path);

/// The picture in the page itself, its file's name under it. Throws as read_png() does.
[[nodiscard]] Html picture_figure(const std::filesystem::path& path);

} // namespace tetrace
