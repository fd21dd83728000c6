#pragma once

#include "core/mesh/scene.h"
#include "scenes/builder/own_tets.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// Triangles as a file has them: nothing is merged, and only faces of fewer than three corners are removed.
struct MeshSoup {
    TriangleMesh mesh;                    ///< positions are the file's, minus `centre`, rounded to float
    Double3 centre{};                     ///< of the file's bounding box, if it was subtracted; else 0
    double rounding = 0;                  ///< the largest distance that rounding to float moved a vertex
    std::uint64_t merged_by_rounding = 0; ///< vertices that only rounding put at the place of an earlier one
    std::vector<std::string> notes;       ///< for the user: what was skipped, or is doubtful
    std::vector<TetCorners> tets = {};    ///< of a file that has tets; positive, and `mesh` is their surface_of()
    std::vector<SourceTet> source_tets = {};
    std::uint64_t source_hash = 0; ///< XXH3 of the file's bytes, and of buffers in other files
};

/// Share of the bounding box's largest side: if rounding the coordinates to float would move one by more, the box's
/// centre is subtracted first. Coordinates must be about 16 times as large as the mesh for that, as in surveys.
inline constexpr double max_rounding = 0x1p-20;

/// Reads PLY (ascii, binary of either byte order), OBJ, OFF (with C, N and ST prefixes, or without its keyword), STL
/// (ascii, binary) or glTF 2.0 (.glb, or .gltf with buffers in it or in files of the same folder; its scene's meshes
/// where its nodes put them, without skins and morph targets); or tets, whose surface is the mesh, or triangles:
/// MEDIT's .mesh, Gmsh's .msh, TetGen's .node and .ele of one folder, legacy VTK; all but Gmsh's as text only. A
/// .node file without tets has those of Delaunay: a tet's region is the smallest boundary marker of its corners. The
/// format is chosen by the extension and verified by the content; by the content alone if there is no extension. A
/// UTF-8 byte order mark is skipped, but in binary STL; lines end with LF, CR LF or CR. Polygons are cut into triangles
/// (cut_polygon) when all vertices are known. Coordinates are read as doubles and rounded to float once. Throws
/// Error{missing} if the file does not exist, and Error{invalid_input} that names file, element and remedy for: an
/// unknown format, a truncated file, a count that the file cannot hold, a NaN, infinite or too large coordinate, an
/// index out of range, a mesh without triangles.
[[nodiscard]] MeshSoup read_mesh(const std::filesystem::path& path);

/// The same from a file's bytes; the path serves for its extension and for messages only, so that buffers in other
/// files are refused.
[[nodiscard]] MeshSoup parse_mesh(const std::filesystem::path& path, std::string_view bytes);

} // namespace tetrace
