#pragma once

#include <filesystem>
#include <string_view>

namespace tetrace {

// Files that a user names. Each appears whole or not at all, as an AtomicFile does, and keeps the permissions of the
// file that it replaces. A link stays one: what it leads to is replaced. Written in place, and checked just the same:
// devices and pipes, and files whose folder takes no new file.

/// Writes a file. Throws Error{invalid_input} naming the path and the system's reason where not every byte is written.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

/// Throws what write_whole() would throw at once; leaves no file, and changes nothing.
void require_writable(const std::filesystem::path& path);

} // namespace tetrace
