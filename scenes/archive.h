#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// Reads one member of a gzipped tar archive into memory.
/// Throws Error{invalid_input} naming archive and member where the member is missing, is not a regular file or is
/// larger than max_bytes, or if the archive is damaged.
[[nodiscard]] std::vector<std::byte> read_archive_member(const std::filesystem::path& archive,
                                                         const std::string& member, std::size_t max_bytes);

} // namespace tetrace
