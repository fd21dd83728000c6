#pragma once

#include "core/mesh/scene.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace tetrace {

/// Whether a file's extension names a format of export_tets(): .vtk (legacy VTK), .mesh (MEDIT), .node or .ele
/// (TetGen).
[[nodiscard]] bool is_tets_file(const std::filesystem::path& path);

/// Each tet's region, in the scene's order: that of the file of tets, below all of these for other tets; if there was
/// no such file, 0 for tets that rays from outside reach, and a number for each closed part inside.
[[nodiscard]] std::vector<std::int64_t> regions_of(const Scene& scene);

/// Writes the tets of a scene as text, in the coordinates of its mesh's file, in the scene's order, so those of a file
/// of tets first; then each occlusive face once, with the number of its triangle in the mesh. All formats have the
/// tets' regions. VTK also has the number of a tet in its file (-1 if it
/// is not from there) and its cost, the number of its free faces outside the objects that a uniform line crosses, half
/// of each for either side: they add up to the optimiser's cost. TetGen's form is three files, .node, .ele and .face.
/// Throws Error{invalid_input} naming the path and the system's reason.
void export_tets(const Scene& scene, const std::filesystem::path& path);

} // namespace tetrace
