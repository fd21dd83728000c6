#pragma once

#include <filesystem>
#include <vector>

namespace tetrace {

/// Whether any of these is a folder.
[[nodiscard]] bool has_folder(const std::vector<std::filesystem::path>& paths);

/// The files that these name, each once: files themselves, and of folders all files in them and below them that end in
/// .json, by path. Links to folders are not followed.
/// Throws Error{missing} for a path that is not there, Error{invalid_input} for a folder without such a file or one
/// that cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> files_below(const std::vector<std::filesystem::path>& paths);

} // namespace tetrace
