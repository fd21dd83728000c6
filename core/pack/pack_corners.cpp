#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <bit>

namespace tetrace {

namespace {

/// Quads of a tet packed in this way.
constexpr std::uint32_t corner_quads(std::uint32_t vertex_words)
{
    return vertex_words + 2;
}

/// Packs tets that hold their corners: each vertex's coordinates, padded with 0 to vertex_words words, then each face's
/// {half-face, input triangle}.
/// mesh: see PackTets in core/pack/kernel_id.h.
void pack_corners(PackedScene& packed, const TetMesh& mesh, std::uint32_t vertex_words)
{
    std::vector<std::uint32_t> words;
    words.reserve(4 * std::size_t{corner_quads(vertex_words)});
    packed.tets.reserve(mesh.tets.size() * corner_quads(vertex_words));
    for (const Tet& tet : mesh.tets) {
        words.clear();
        for (const std::uint32_t vertex : tet.vertices) {
            for (int axis = 0; axis < 3; ++axis)
                words.push_back(std::bit_cast<std::uint32_t>(mesh.vertices[vertex][axis]));
            words.resize(words.size() + vertex_words - 3);
        }
        for (std::size_t face = 0; face < 4; ++face)
            words.insert(words.end(), {tet.neighbours[face], tet.faces[face]});
        for (std::size_t i = 0; i < words.size(); i += 4)
            packed.tets.push_back({words[i], words[i + 1], words[i + 2], words[i + 3]});
    }
}

} // namespace

static_assert(corner_quads(3) == TET80_QUADS);

void pack_tet80(PackedScene& packed, const TetMesh& mesh)
{
    pack_corners(packed, mesh, 3);
}

static_assert(corner_quads(4) == TET96_QUADS);

void pack_tet96(PackedScene& packed, const TetMesh& mesh)
{
    pack_corners(packed, mesh, 4);
}

} // namespace tetrace
