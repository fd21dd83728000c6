#pragma once

#include "core/pack/packed_scene.h"

namespace tetrace {

/// Packs tets that hold their corners: of each vertex its coordinates and 0 up to vertex_words words, then {link, input
/// triangle} of each face.
/// mesh: see PackTets in core/pack/traits.h.
void pack_corners(PackedScene& packed, const TetMesh& mesh, std::uint32_t vertex_words);

/// Quads of a tet that is packed so.
constexpr std::uint32_t corner_quads(std::uint32_t vertex_words)
{
    return vertex_words + 2;
}

} // namespace tetrace
