#pragma once

#include "core/pack/packed_scene.h"

namespace tetrace {

/// Packs tets that share their vertices, tet20 or tet16: `tets`, `vertices`, `occlusive_faces`, and of the links in
/// `entry_links` the `entry_faces` instead. Vertices are numbered as the tets first name them, so that they lie as the
/// tets do.
/// packed: with its layout and entry_links. mesh: the scene's tets in packed order, linked by it.
/// Throws Error{unsupported} where a walk could not know the vertices of a tet by those of the one it comes from: its
/// neighbours do not name it back; or where a face of the boundary is occlusive, or there are too many that are.
/// Source: Aman, Demirci, Guedukbay, "Compact Tetrahedralization-Based Acceleration Structures for Ray Tracing",
/// Journal of Visualization 25, 2022; docs/spec/layouts.md, L8.
void pack_compact(PackedScene& packed, const TetMesh& mesh);

/// The tets that were packed: with the same vertices, in whichever order gives them their orientation.
/// Throws Error{invalid_input} where the words contradict each other.
[[nodiscard]] TetMesh unpack_compact(const PackedScene& packed);

} // namespace tetrace
