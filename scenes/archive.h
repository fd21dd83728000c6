#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// One member of a gzipped tar archive; nothing else of it is kept, and nothing is written.
/// Throws Error{invalid_input} naming archive and member where it is not there, is no regular file, is larger than
/// max_bytes, or the archive is damaged before its end.
[[nodiscard]] std::vector<std::byte> read_archive_member(const std::filesystem::path& archive,
                                                         const std::string& member, std::size_t max_bytes);

} // namespace tetrace
