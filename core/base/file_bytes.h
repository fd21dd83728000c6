#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

namespace tetrace {

/// The bytes of a file, or the first `most` of a longer one. Empty if it cannot be opened, or not be read so far: a
/// folder, a disk with errors, a process of /proc that ends meanwhile. (An istreambuf_iterator throws there.)
[[nodiscard]] std::optional<std::string> file_bytes(const std::filesystem::path& path,
                                                    std::size_t most = std::numeric_limits<std::size_t>::max());

} // namespace tetrace
