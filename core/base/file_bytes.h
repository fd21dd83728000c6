#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tetrace {

/// All bytes of a file. Empty where it cannot be opened, or not be read to its end: a folder, a disk with errors, a
/// process of /proc that ends meanwhile. (An istreambuf_iterator throws there.)
[[nodiscard]] std::optional<std::string> file_bytes(const std::filesystem::path& path);

} // namespace tetrace
