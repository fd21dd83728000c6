#pragma once

#include "core/base/hash.h"

#include <filesystem>
#include <string_view>

namespace tetrace {

/// The file of a glTF buffer: the name that its `uri` has without percent-encoding, in `folder`. Empty if that is not a
/// plain name (it has a '/' or a NUL, or is "." or ".."): no other folder is looked into.
[[nodiscard]] std::filesystem::path gltf_buffer_file(const std::filesystem::path& folder, std::string_view uri);

/// Adds the bytes of the buffers that a .gltf file has in other files of its folder, of those that exist, in its order.
/// json: the file's own text; nothing is added if it is damaged.
void add_gltf_buffers(Hasher& hasher, const std::filesystem::path& gltf, std::string_view json);

/// Adds a file's bytes, piece by piece; returns how many. Throws nothing: a file that cannot be read has none.
std::uint64_t add_file(Hasher& hasher, const std::filesystem::path& path);

} // namespace tetrace
