#include "core/base/error.h"
#include "core/mesh/tet_mesh.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

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

namespace {

const Tet& tet_of(const TetMesh& mesh, std::uint32_t half_face)
{
    return mesh.tets[half_face_tet(half_face)];
}

// Vertex `face ^ fold` of the tet is vertex `face ^ fold` of the tet across that face, each with its own number of it.
std::uint32_t fold_at(const TetMesh& mesh, const Tet& tet, std::uint32_t face)
{
    const Tet& next = tet_of(mesh, tet.neighbours[face]);
    const std::uint32_t entry = half_face_index(tet.neighbours[face]);
    for (std::uint32_t fold = 1; fold < 3; ++fold)
        if (tet.vertices[face ^ fold] == next.vertices[entry ^ fold]) return fold;
    return 3; // also if no corner is shared: tests damage half-faces
}

std::uint32_t side_word(std::uint32_t half_face)
{
    return half_face == NO_HALF_FACE ? NO_HALF_FACE : EXIT_IS_NORMAL | half_face;
}

// The row of each occlusive face, by its half-face; replaces the rows of the input triangles by them.
std::vector<std::uint32_t> pack_rows(PackedScene& packed, const TetMesh& mesh)
{
    std::vector<std::uint32_t> row_of(mesh.tets.size() * 4, NO_HALF_FACE);
    std::vector<Quad> rows;
    for (std::uint32_t own = 0; own < row_of.size(); ++own) {
        const std::uint32_t triangle = tet_of(mesh, own).faces[half_face_index(own)];
        const std::uint32_t half_face = tet_of(mesh, own).neighbours[half_face_index(own)];
        if (triangle == FREE_FACE) continue;
        const bool has_row = half_face < own && row_of[half_face] != NO_HALF_FACE &&
                             tet_of(mesh, half_face).neighbours[half_face_index(half_face)] == own;
        row_of[own] = has_row ? row_of[half_face] : static_cast<std::uint32_t>(rows.size() / TRIANGLE_QUADS);
        if (has_row) continue;
        const Quad* const quads = &packed.triangles.at(std::size_t{TRIANGLE_QUADS} * triangle);
        rows.insert(rows.end(), quads, quads + TRIANGLE_QUADS);
        rows[rows.size() - 3].w = NORMAL_BIAS + triangle;
        rows[rows.size() - 2].w = side_word(own);
        rows[rows.size() - 1].w = side_word(half_face);
    }
    packed.triangles = std::move(rows);
    return row_of;
}

std::uint32_t exit_word(const TetMesh& mesh, const Tet& tet, std::uint32_t face, std::uint32_t row)
{
    if (row != NO_HALF_FACE) return EXIT_IS_NORMAL | row << 2 | EXIT_END;
    const std::uint32_t half_face = tet.neighbours[face];
    return half_face == NO_HALF_FACE ? NO_HALF_FACE : EXIT_IS_NORMAL | half_face << 2 | fold_at(mesh, tet, face) % 3;
}

} // namespace

void pack_tet64(PackedScene& packed, const TetMesh& mesh)
{
    const std::vector<std::uint32_t> row_of = pack_rows(packed, mesh);
    if (const std::size_t rows = packed.triangles.size() / TRIANGLE_QUADS; rows > TET64_MAX_ROWS)
        throw Error(ErrorKind::unsupported, "packing as tet64: " + std::to_string(rows) +
                                                " occlusive faces, its exits name at most " +
                                                std::to_string(TET64_MAX_ROWS));
    packed.tets.reserve(row_of.size());
    for (std::uint32_t own = 0; own < row_of.size(); ++own) {
        const Tet& tet = tet_of(mesh, own);
        const Float3 vertex = mesh.vertices[tet.vertices[half_face_index(own)]];
        packed.tets.push_back({std::bit_cast<std::uint32_t>(vertex.x), std::bit_cast<std::uint32_t>(vertex.y),
                               std::bit_cast<std::uint32_t>(vertex.z),
                               exit_word(mesh, tet, half_face_index(own), row_of[own])});
    }
}

} // namespace tetrace
