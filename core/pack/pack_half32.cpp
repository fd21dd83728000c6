#include "core/base/error.h"
#include "core/mesh/face_corners.h"
#include "core/pack/packed_scene.h"
#include "core/pack/traits.h"

#include <algorithm>
#include <bit>

namespace tetrace {
namespace {

std::array<std::uint32_t, 3> corners_of(const Tet& tet, std::uint32_t face)
{
    const auto& corners = face_corners[face];
    return {tet.vertices[corners[0]], tet.vertices[corners[1]], tet.vertices[corners[2]]};
}

// What is across the face opposite corner `index` of the entry face, for a ray that entered by `entry`.
std::uint32_t exit_word(const TetMesh& mesh, const Tet& tet, std::uint32_t entry, std::size_t index)
{
    const std::uint32_t face = face_corners[entry][index];
    if (tet.faces[face] != FREE_FACE) return tet.faces[face] << 2 | EXIT_END;
    const std::uint32_t half_face = tet.neighbours[face];
    if (half_face == NO_HALF_FACE) return NO_HALF_FACE;
    auto carried = corners_of(tet, entry);
    carried[index] = tet.vertices[entry];
    const std::uint32_t first = corners_of(mesh.tets[half_face_tet(half_face)], half_face_index(half_face))[0];
    const auto turned = std::ranges::find(carried, first);
    const auto rotation = (turned - carried.begin()) % 3; // 0 if no corner is shared: tests damage half-faces
    return half_face << 2 | static_cast<std::uint32_t>(rotation);
}

} // namespace

void pack_half32(PackedScene& packed, const TetMesh& mesh)
{
    if (const std::size_t triangles = packed.triangles.size() / TRIANGLE_QUADS; triangles > HALF32_MAX_TRIANGLES)
        throw Error(ErrorKind::unsupported, "packing as half32: " + std::to_string(triangles) +
                                                " triangles, its records name at most " +
                                                std::to_string(HALF32_MAX_TRIANGLES));
    packed.tets.reserve(mesh.tets.size() * 4 * HALF32_QUADS);
    for (const Tet& tet : mesh.tets)
        for (std::uint32_t entry = 0; entry < 4; ++entry) {
            const Float3 apex = mesh.vertices[tet.vertices[entry]];
            packed.tets.push_back({std::bit_cast<std::uint32_t>(apex.x), std::bit_cast<std::uint32_t>(apex.y),
                                   std::bit_cast<std::uint32_t>(apex.z), 0});
            packed.tets.push_back({exit_word(mesh, tet, entry, 0), exit_word(mesh, tet, entry, 1),
                                   exit_word(mesh, tet, entry, 2), tet.neighbours[entry]});
        }
}

} // namespace tetrace
