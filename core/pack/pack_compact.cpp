#include "core/base/error.h"
#include "core/mesh/tet_mesh.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace tetrace {

namespace {

using FourWords = std::array<std::uint32_t, 4>;

/// Appends the words of a tet. vertices: the xor of its four. behind: what is across the face opposite each of them
/// (kernels/layouts/layout.h), by ascending number of the vertex.
using AddTet = void(std::vector<std::uint32_t>& words, std::uint32_t vertices, const FourWords& behind);

constexpr std::uint32_t not_numbered = 0xFFFFFFFFu;

[[noreturn]] void reject(Layout layout, const std::string& what)
{
    throw Error(ErrorKind::unsupported, "packing as " + std::string(name_of(layout)) + ": " + what);
}

bool has_vertex(const Tet& tet, std::uint32_t vertex)
{
    return std::ranges::find(tet.vertices, vertex) != tet.vertices.end();
}

/// Whether a walk that leaves the tet by the face knows three vertices of the next tet.
bool is_named_back(const TetMesh& mesh, std::uint32_t tet, std::uint32_t face)
{
    const std::uint32_t half_face = mesh.tets[tet].neighbours[face];
    const Tet& next = mesh.tets[half_face_tet(half_face)];
    if (next.neighbours[half_face_index(half_face)] != make_half_face(tet, face)) return false;
    for (const std::uint32_t i : face_corners[face])
        if (!has_vertex(next, mesh.tets[tet].vertices[i])) return false;
    return !has_vertex(mesh.tets[tet], next.vertices[half_face_index(half_face)]);
}

void require_walkable(const TetMesh& mesh, Layout layout)
{
    for (std::uint32_t tet = 0; tet < mesh.tets.size(); ++tet)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const bool is_boundary = mesh.tets[tet].neighbours[face] == NO_HALF_FACE;
            if (is_boundary && mesh.tets[tet].faces[face] != FREE_FACE)
                reject(layout, "tet " + std::to_string(tet) + " has an occlusive face on the domain's boundary");
            if (!is_boundary && !is_named_back(mesh, tet, face))
                reject(layout, "tet " + std::to_string(tet) + " and its neighbour across face " + std::to_string(face) +
                                   " do not name each other");
        }
}

/// The number of each vertex of the mesh, in the order in which the tets first name them.
std::vector<std::uint32_t> number_vertices(const TetMesh& mesh)
{
    std::vector<std::uint32_t> number(mesh.vertices.size(), not_numbered);
    std::uint32_t count = 0;
    for (const Tet& tet : mesh.tets)
        for (const std::uint32_t vertex : tet.vertices)
            if (number[vertex] == not_numbered) number[vertex] = count++;
    return number;
}

/// Quads of the vertices that tets name.
std::vector<Quad> vertex_quads(const TetMesh& mesh, const std::vector<std::uint32_t>& number)
{
    const auto count = std::ranges::count_if(number, [](std::uint32_t i) { return i != not_numbered; });
    std::vector<Quad> quads(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] == not_numbered) continue;
        const Float3 at = mesh.vertices[i];
        quads[number[i]] = {std::bit_cast<std::uint32_t>(at.x), std::bit_cast<std::uint32_t>(at.y),
                            std::bit_cast<std::uint32_t>(at.z), 0};
    }
    return quads;
}

FourWords numbered(const Tet& tet, const std::vector<std::uint32_t>& number)
{
    FourWords vertices;
    std::ranges::transform(tet.vertices, vertices.begin(), [&](auto v) { return number[v]; });
    return vertices;
}

/// What is across each face of each tet, in the form of layout.h; fills the table of occlusive faces.
std::vector<FourWords> words_behind(const TetMesh& mesh, std::vector<std::uint32_t>& occlusive_faces, Layout layout)
{
    std::vector<FourWords> behind(mesh.tets.size());
    for (std::uint32_t tet = 0; tet < mesh.tets.size(); ++tet)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const std::uint32_t half_face = mesh.tets[tet].neighbours[face];
            const std::uint32_t triangle = mesh.tets[tet].faces[face];
            if (half_face == NO_HALF_FACE || triangle == FREE_FACE) {
                behind[tet][face] = half_face == NO_HALF_FACE ? NO_HALF_FACE : half_face_tet(half_face);
            } else if (tet < half_face_tet(half_face)) {
                const std::size_t side = 2 * (occlusive_faces.size() / OCCLUSIVE_WORDS);
                if (side >= OCCLUSIVE - 2) reject(layout, "more than 1,073,741,823 occlusive faces");
                occlusive_faces.insert(occlusive_faces.end(), {triangle, tet, half_face_tet(half_face)});
                behind[tet][face] = OCCLUSIVE | static_cast<std::uint32_t>(side);
                behind[half_face_tet(half_face)][half_face_index(half_face)] =
                    OCCLUSIVE | static_cast<std::uint32_t>(side + 1);
            }
        }
    return behind;
}

/// What is across the faces, sorted by the numbers of their opposite vertices.
FourWords sorted_by(const FourWords& vertices, const FourWords& behind)
{
    std::array<std::uint32_t, 4> order{0, 1, 2, 3};
    std::ranges::sort(order, [&](auto a, auto b) { return vertices[a] < vertices[b]; });
    return {behind[order[0]], behind[order[1]], behind[order[2]], behind[order[3]]};
}

std::uint32_t xor_of(const FourWords& words)
{
    return words[0] ^ words[1] ^ words[2] ^ words[3];
}

std::vector<Quad> quads_of_words(std::vector<std::uint32_t> words)
{
    words.resize((words.size() + 3) / 4 * 4);
    std::vector<Quad> quads;
    for (std::size_t i = 0; i < words.size(); i += 4)
        quads.push_back({words[i], words[i + 1], words[i + 2], words[i + 3]});
    return quads;
}

void name_entry_faces(PackedScene& packed, const TetMesh& mesh)
{
    for (const std::uint32_t half_face : packed.entry_half_faces) {
        const FourWords vertices = numbered(mesh.tets[half_face_tet(half_face)], packed.number_of_vertex);
        const auto& corners = face_corners[half_face_index(half_face)];
        packed.entry_faces.push_back(
            {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], half_face_tet(half_face)});
    }
    packed.entry_half_faces.clear();
}

/// Packs tets that share their vertices: `tets`, `vertices`, `occlusive_faces`, and `entry_faces` in place of
/// `entry_half_faces`. Vertices are numbered in the order in which the tets first name them, so that they are near
/// their tets' order in memory.
/// mesh: see PackTets in core/pack/kernel_id.h.
/// Throws Error{unsupported} if a tet and its neighbour do not name each other, so that a walk could not derive the
/// tet's vertices; if a face of the boundary is occlusive; or if there are too many occlusive faces. Source: Aman,
/// Demirci, Guedukbay, "Compact Tetrahedralization-Based Acceleration Structures for Ray Tracing", Journal of
/// Visualization 25, 2022; docs/spec/layouts.md, L8.
void pack_compact(PackedScene& packed, const TetMesh& mesh, AddTet& add_tet)
{
    require_walkable(mesh, packed.layout);
    packed.number_of_vertex = number_vertices(mesh);
    packed.vertices = vertex_quads(mesh, packed.number_of_vertex);
    const std::vector<FourWords> behind = words_behind(mesh, packed.occlusive_faces, packed.layout);
    std::vector<std::uint32_t> words;
    for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
        const FourWords vertices = numbered(mesh.tets[tet], packed.number_of_vertex);
        const FourWords sorted = sorted_by(vertices, behind[tet]);
        add_tet(words, xor_of(vertices), sorted);
        packed.last_neighbours.push_back(sorted[3]);
    }
    packed.tets = quads_of_words(std::move(words));
    name_entry_faces(packed, mesh);
}

} // namespace

void pack_tet20(PackedScene& packed, const TetMesh& mesh)
{
    pack_compact(
        packed, mesh, *[](std::vector<std::uint32_t>& words, std::uint32_t vertices, const FourWords& behind) {
            words.insert(words.end(), {vertices, behind[0], behind[1], behind[2], behind[3]});
        });
}

void pack_tet16(PackedScene& packed, const TetMesh& mesh)
{
    pack_compact(
        packed, mesh, *[](std::vector<std::uint32_t>& words, std::uint32_t vertices, const FourWords& behind) {
            words.insert(words.end(), {vertices, behind[0] ^ behind[3], behind[1] ^ behind[3], behind[2] ^ behind[3]});
        });
}

} // namespace tetrace
