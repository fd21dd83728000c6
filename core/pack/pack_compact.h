#pragma once

#include "core/pack/packed_scene.h"

#include <array>

namespace tetrace {

using FourWords = std::array<std::uint32_t, 4>;

/// Appends the words of a tet. vertices: the xor of its four. behind: what is behind the face opposite each of them
/// (kernels/layouts/layout.h), by the vertices' numbers ascending.
using AddTet = void(std::vector<std::uint32_t>& words, std::uint32_t vertices, const FourWords& behind);

/// Packs tets that share their vertices: `tets`, `vertices`, `occlusive_faces`, and of the links in `entry_links` the
/// `entry_faces` instead. Vertices are numbered as the tets first name them, so that they lie as the tets do.
/// mesh: see PackTets in core/pack/traits.h.
/// Throws Error{unsupported} where a walk could not know the vertices of a tet by those of the one it comes from: its
/// neighbours do not name it back; or where a face of the boundary is occlusive, or there are too many that are.
/// Source: Aman, Demirci, Guedukbay, "Compact Tetrahedralization-Based Acceleration Structures for Ray Tracing",
/// Journal of Visualization 25, 2022; docs/spec/layouts.md, L8.
void pack_compact(PackedScene& packed, const TetMesh& mesh, AddTet& add_tet);

} // namespace tetrace
