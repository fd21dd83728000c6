#pragma once

#include "core/pack/packed_scene.h"

namespace tetrace {

/// Packs tets that hold their corners: each vertex's coordinates, padded with 0 to vertex_words words, then each face's
/// {half-face, input triangle}.
/// mesh: see PackTets in core/pack/traits.h.
void pack_corners(PackedScene& packed, const TetMesh& mesh, std::uint32_t vertex_words);

/// Quads of a tet packed in this way.
constexpr std::uint32_t corner_quads(std::uint32_t vertex_words)
{
    return vertex_words + 2;
}

} // namespace tetrace
