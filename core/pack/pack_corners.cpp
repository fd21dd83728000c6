#include "core/pack/pack_corners.h"

#include <bit>

namespace tetrace {

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

} // namespace tetrace
