#pragma once

#include "core/mesh/triangle_mesh.h"

#include <filesystem>

namespace tetrace {

/// Writes a mesh as it is, for the program that has started this one.
/// Throws Error{invalid_input} naming the path and the system's reason.
void write_raw_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// Reads what write_raw_mesh() has written. Throws Error{internal} for anything else.
[[nodiscard]] TriangleMesh read_raw_mesh(const std::filesystem::path& path);

} // namespace tetrace
