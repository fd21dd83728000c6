#pragma once

#include "core/mesh/scene.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace tetrace {

/// Whether a file's extension names a format of export_tets(): .vtk (legacy VTK), .vtu (VTK's XML), .mesh
/// (MEDIT), .node or .ele (TetGen).
[[nodiscard]] bool is_tets_file(const std::filesystem::path& path);

/// Each tet's region, in the scene's order: that of the file of tets, below all of these for other tets; if there was
/// no such file, 0 for tets that rays from outside reach, and a number for each closed part inside.
[[nodiscard]] std::vector<std::int64_t> regions_of(const Scene& scene);

/// Each tet's number in the file of tets; -1: it has none, as tets that fill the box or were optimised.
[[nodiscard]] std::vector<std::int64_t> numbers_of(const Scene& scene);

/// Each tet's volume, in units of the mesh.
[[nodiscard]] std::vector<double> volumes_of(const Scene& scene);

/// Writes the tets of a scene as text, in the coordinates of its mesh's file, in the scene's order, so those of a file
/// of tets first; then each occlusive face once, with the number of its triangle in the mesh. All formats have the
/// tets' regions. VTK also has numbers_of() and each tet's cost, the number of its
/// free faces that a uniform line crosses, half of each for either side: they add up to the optimiser's cost. Without a
/// file of tets, only faces outside the objects cost. TetGen's form is three files, .node, .ele and .face.
/// Throws Error{invalid_input} naming the path and the system's reason.
void export_tets(const Scene& scene, const std::filesystem::path& path);

} // namespace tetrace
