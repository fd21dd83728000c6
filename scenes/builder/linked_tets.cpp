#include "scenes/builder/linked_tets.h"

#include <algorithm>

namespace tetrace {

LinkedTets::LinkedTets(TetMesh& mesh)
    : mesh_(mesh), tet_of_(mesh.vertices.size(), NO_HALF_FACE), is_gone_(mesh.tets.size(), false)
{
    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i)
        note(i);
}

std::vector<std::uint32_t> LinkedTets::star(std::uint32_t vertex) const
{
    std::vector<std::uint32_t> tets{tet_of_[vertex]};
    std::set<std::uint32_t> seen{tets.front()};
    for (std::size_t i = 0; i < tets.size(); ++i) {
        const Tet& tet = mesh_.tets[tets[i]];
        for (std::size_t face = 0; face < 4; ++face)
            if (tet.vertices[face] != vertex && tet.neighbours[face] != NO_HALF_FACE &&
                seen.insert(half_face_tet(tet.neighbours[face])).second)
                tets.push_back(half_face_tet(tet.neighbours[face]));
    }
    return tets;
}

void LinkedTets::rename(std::uint32_t tet, std::uint32_t from, std::uint32_t to)
{
    std::ranges::replace(mesh_.tets[tet].vertices, from, to);
    note(tet);
}

void LinkedTets::join(std::uint32_t half_face, std::uint32_t to, std::uint32_t triangle)
{
    if (half_face == NO_HALF_FACE) return;
    Tet& tet = mesh_.tets[half_face_tet(half_face)];
    tet.neighbours[half_face_index(half_face)] = to;
    tet.faces[half_face_index(half_face)] = triangle;
    note(half_face_tet(half_face));
}

std::vector<std::uint32_t> LinkedTets::grown(const std::vector<std::uint32_t>& tets) const
{
    std::set<std::uint32_t> all(tets.begin(), tets.end());
    for (const std::uint32_t index : tets)
        for (std::size_t face = 0; face < 4; ++face)
            if (mesh_.tets[index].neighbours[face] != NO_HALF_FACE && mesh_.tets[index].faces[face] == FREE_FACE)
                all.insert(half_face_tet(mesh_.tets[index].neighbours[face]));
    return {all.begin(), all.end()};
}

CavitySides LinkedTets::sides_of(const std::vector<std::uint32_t>& tets) const
{
    CavitySides sides;
    const std::set<std::uint32_t> inside(tets.begin(), tets.end());
    for (const std::uint32_t index : tets) {
        const Tet& tet = mesh_.tets[index];
        for (std::size_t face = 0; face < 4; ++face) {
            const std::uint32_t half_face = tet.neighbours[face];
            const bool is_inner = half_face != NO_HALF_FACE && inside.contains(half_face_tet(half_face));
            if (is_inner && tet.faces[face] != FREE_FACE) return {};
            if (!is_inner) sides.emplace(face_side_of(tet.vertices, face), AcrossFace{half_face, tet.faces[face]});
        }
    }
    return sides;
}

void LinkedTets::replace(const std::vector<std::uint32_t>& tets, CavitySides sides,
                         const std::vector<std::array<std::uint32_t, 4>>& by)
{
    for (const std::uint32_t tet : tets)
        remove(tet);
    for (const auto& corners : by)
        add(corners, sides);
}

void LinkedTets::drop_gone()
{
    std::vector<std::uint32_t> place(mesh_.tets.size());
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < place.size(); ++i) {
        if (is_gone_[i]) continue;
        mesh_.tets[kept] = mesh_.tets[i];
        place[i] = kept++;
    }
    mesh_.tets.resize(kept);
    for (Tet& tet : mesh_.tets)
        for (std::uint32_t& half_face : tet.neighbours)
            if (half_face != NO_HALF_FACE)
                half_face = make_half_face(place[half_face_tet(half_face)], half_face_index(half_face));
}

void LinkedTets::note(std::uint32_t tet)
{
    for (const std::uint32_t vertex : mesh_.tets[tet].vertices)
        tet_of_[vertex] = tet;
}

// A tet with some of these sides; its others are for those that follow.
void LinkedTets::add(const std::array<std::uint32_t, 4>& corners, CavitySides& sides)
{
    const auto index = static_cast<std::uint32_t>(mesh_.tets.size());
    mesh_.tets.push_back({corners,
                          {NO_HALF_FACE, NO_HALF_FACE, NO_HALF_FACE, NO_HALF_FACE},
                          {FREE_FACE, FREE_FACE, FREE_FACE, FREE_FACE}});
    is_gone_.push_back(false);
    note(index);
    for (std::uint32_t face = 0; face < 4; ++face) {
        const FaceSide side = face_side_of(corners, face);
        const std::uint32_t own = make_half_face(index, face);
        const auto known = sides.find(side);
        if (known == sides.end()) {
            sides.emplace(reversed(side), AcrossFace{own, FREE_FACE});
            continue;
        }
        const auto [half_face, triangle] = known->second;
        join(own, half_face, triangle);
        join(half_face, own, triangle);
    }
}

} // namespace tetrace
