#include "core/pack/pack_half32.h"

#include "core/base/error.h"
#include "core/mesh/face_corners.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <tuple>

namespace tetrace {
namespace {

std::tuple<float, float, float> place_of(Float3 a)
{
    return {a.x, a.y, a.z};
}

// Of each vertex, in the order of is_before() in kernels/methods/signs.h.
std::vector<std::uint32_t> ranks_of(const std::vector<Float3>& vertices)
{
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return place_of(vertices[a]) < place_of(vertices[b]); });
    std::vector<std::uint32_t> ranks(order.size());
    for (std::uint32_t rank = 0; rank < order.size(); rank++)
        ranks[order[rank]] = FIRST_RANK + rank;
    return ranks;
}

std::array<std::uint32_t, 3> corners_of(const Tet& tet, std::uint32_t face)
{
    const auto& corners = face_corners[face];
    return {tet.vertices[corners[0]], tet.vertices[corners[1]], tet.vertices[corners[2]]};
}

// What a ray that has entered by `entry` finds behind the face opposite the entry face's corner `index`.
std::uint32_t exit_word(const TetMesh& mesh, const Tet& tet, std::uint32_t entry, std::size_t index)
{
    const std::uint32_t face = face_corners[entry][index];
    if (tet.faces[face] != FREE_FACE) return tet.faces[face] << 2 | HALF32_END;
    const std::uint32_t link = tet.links[face];
    if (link == NO_LINK) return NO_LINK;
    auto carried = corners_of(tet, entry);
    carried[index] = tet.vertices[entry];
    const std::uint32_t first = corners_of(mesh.tets[link_tet(link)], link_face(link))[0];
    const auto turned = std::find(carried.begin(), carried.end(), first);
    const auto rotation = (turned - carried.begin()) % 3; // 0 where no corner is shared: tests damage links
    return link << 2 | static_cast<std::uint32_t>(rotation);
}

// The triangle that an exit ends at; FREE_FACE where it does not, and at the domain's boundary.
std::uint32_t triangle_at(std::uint32_t exit)
{
    return (exit & 3u) == HALF32_END && exit != NO_LINK ? exit >> 2 : FREE_FACE;
}

// Whether the neighbour behind a face has that face as its own; the domain's boundary always has.
bool is_linked_back(const TetMesh& mesh, std::uint32_t face)
{
    const std::uint32_t link = mesh.tets[link_tet(face)].links[link_face(face)];
    return link == NO_LINK ||
           (link_tet(link) < mesh.tets.size() && mesh.tets[link_tet(link)].links[link_face(link)] == face);
}

[[noreturn]] void reject(std::size_t record, const char* why)
{
    throw Error(ErrorKind::internal, "half32: record " + std::to_string(record) + ": " + why);
}

} // namespace

std::vector<Quad> half32_records(const TetMesh& mesh)
{
    const auto ranks = ranks_of(mesh.vertices);
    std::vector<Quad> quads;
    quads.reserve(mesh.tets.size() * 4 * HALF32_QUADS);
    for (const Tet& tet : mesh.tets)
        for (std::uint32_t entry = 0; entry < 4; entry++) {
            const Float3 apex = mesh.vertices[tet.vertices[entry]];
            quads.push_back({std::bit_cast<std::uint32_t>(apex.x), std::bit_cast<std::uint32_t>(apex.y),
                             std::bit_cast<std::uint32_t>(apex.z), ranks[tet.vertices[entry]]});
            quads.push_back({exit_word(mesh, tet, entry, 0), exit_word(mesh, tet, entry, 1),
                             exit_word(mesh, tet, entry, 2), tet.links[entry]});
        }
    return quads;
}

TetMesh half32_tets(const std::vector<Quad>& records)
{
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> index;
    TetMesh mesh;
    mesh.tets.resize(records.size() / (4 * HALF32_QUADS));
    for (std::size_t record = 0; record < 4 * mesh.tets.size(); record++) {
        Tet& tet = mesh.tets[record / 4];
        const std::size_t entry = record % 4;
        const Quad &apex = records[HALF32_QUADS * record], &exits = records[HALF32_QUADS * record + 1];
        const auto [place, is_new] =
            index.try_emplace({apex.x, apex.y, apex.z}, static_cast<std::uint32_t>(mesh.vertices.size()));
        if (is_new)
            mesh.vertices.push_back(
                {std::bit_cast<float>(apex.x), std::bit_cast<float>(apex.y), std::bit_cast<float>(apex.z)});
        tet.vertices[entry] = place->second;
        tet.links[entry] = exits.w;
        const auto& faces = face_corners[entry];
        tet.faces[faces[0]] = triangle_at(exits.x);
        tet.faces[faces[1]] = triangle_at(exits.y);
        tet.faces[faces[2]] = triangle_at(exits.z);
    }
    for (std::uint32_t record = 0; record < 4 * mesh.tets.size(); record++)
        if (!is_linked_back(mesh, record)) reject(record, "its neighbour does not lead back");
    const std::vector<Quad> again = half32_records(mesh);
    const auto differing = std::mismatch(records.begin(), records.end(), again.begin()).first;
    if (differing != records.end())
        reject(static_cast<std::size_t>(differing - records.begin()) / HALF32_QUADS,
               "it contradicts the others of its tet, or those of its neighbours");
    return mesh;
}

} // namespace tetrace
