#pragma once

#include "core/pack/packed_scene.h"

#include <array>

namespace tetrace {

using FourWords = std::array<std::uint32_t, 4>;

/// Appends the words of a tet. vertices: the xor of its four. behind: what is across the face opposite each of them
/// (kernels/layouts/layout.h), by ascending number of the vertex.
using AddTet = void(std::vector<std::uint32_t>& words, std::uint32_t vertices, const FourWords& behind);

/// Packs tets that share their vertices: `tets`, `vertices`, `occlusive_faces`, and `entry_faces` in place of
/// `entry_half_faces`. Vertices are numbered in the order in which the tets first name them, so that they are near
/// their tets' order in memory.
/// mesh: see PackTets in core/pack/traits.h.
/// Throws Error{unsupported} if a tet and its neighbour do not name each other, so that a walk could not derive the
/// tet's vertices; if a face of the boundary is occlusive; or if there are too many occlusive faces. Source: Aman,
/// Demirci, Guedukbay, "Compact Tetrahedralization-Based Acceleration Structures for Ray Tracing", Journal of
/// Visualization 25, 2022; docs/spec/layouts.md, L8.
void pack_compact(PackedScene& packed, const TetMesh& mesh, AddTet& add_tet);

} // namespace tetrace
