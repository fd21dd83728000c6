#pragma once

#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tetrace {

/// Triangles as a file has them: nothing is merged, and only faces of fewer than three corners are removed.
struct MeshSoup {
    TriangleMesh mesh;
    std::uint64_t skipped_faces = 0; ///< faces of fewer than three corners
    std::uint64_t source_hash = 0;   ///< XXH3 of the file's bytes
};

/// Reads PLY (ascii, binary of either byte order), OBJ, OFF (with C, N and ST prefixes), STL (ascii, binary) or
/// glTF 2.0 (.glb, or .gltf that holds its buffers; its scene's meshes where its nodes put them, without skins and
/// morph targets), chosen by the extension and verified by the content; a UTF-8 byte order mark is skipped, but in STL.
/// Polygons are cut into fans, or by ears where these would overlap; coordinates are rounded to the nearest float.
/// Throws Error{missing} if the file does not exist, and Error{invalid_input} that names file, element and remedy for:
/// an unknown format, a truncated file, a count that the file cannot hold, a NaN, infinite or too large coordinate, an
/// index out of range, a mesh without triangles.
[[nodiscard]] MeshSoup read_mesh(const std::filesystem::path& path);

/// The same from a file's bytes; the path serves for its extension and for messages only.
[[nodiscard]] MeshSoup parse_mesh(const std::filesystem::path& path, std::string_view bytes);

} // namespace tetrace
