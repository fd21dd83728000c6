#include "scenes/optimise/mesh_arrays.h"

#include "core/mesh/tet_mesh.h"
#include "scenes/optimise/shape.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace tetrace {
namespace {

std::array<std::uint32_t, 3> face_vertices(const Tet& tet, std::uint32_t face)
{
    const auto& [a, b, c] = face_corners[face];
    return {tet.vertices[a], tet.vertices[b], tet.vertices[c]};
}

void find_reached(MeshArrays& arrays)
{
    std::vector<std::uint32_t> front;
    const auto reach = [&](std::uint32_t tet) {
        if (std::exchange(arrays.states[tet], TetState::reached) == TetState::hidden) front.push_back(tet);
    };
    for (std::uint32_t t = 0; t < arrays.tets.size(); ++t)
        for (std::size_t face = 0; face < 4; ++face)
            if (arrays.tets[t].neighbours[face] == NO_HALF_FACE && arrays.tets[t].faces[face] == FREE_FACE) reach(t);
    while (!front.empty()) {
        const Tet& tet = arrays.tets[front.back()];
        front.pop_back();
        for (std::size_t face = 0; face < 4; ++face)
            if (tet.faces[face] == FREE_FACE && tet.neighbours[face] != NO_HALF_FACE)
                reach(half_face_tet(tet.neighbours[face]));
    }
}

void find_box_sides(MeshArrays& arrays)
{
    std::vector<std::uint32_t> on_boundary;
    Double3 low{impossible, impossible, impossible}, high = low * -1.0;
    for (const Tet& tet : arrays.tets)
        for (std::uint32_t face = 0; face < 4; ++face) {
            if (tet.neighbours[face] != NO_HALF_FACE) continue;
            for (const std::uint32_t v : face_vertices(tet, face)) {
                on_boundary.push_back(v);
                const Double3 at = arrays.points[v];
                low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
                high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
            }
        }
    for (const std::uint32_t v : on_boundary) {
        const Double3 at = arrays.points[v];
        arrays.box_sides[v] = (at.x == low.x ? 1u : 0u) | (at.x == high.x ? 2u : 0u) | (at.y == low.y ? 4u : 0u) |
                              (at.y == high.y ? 8u : 0u) | (at.z == low.z ? 16u : 0u) | (at.z == high.z ? 32u : 0u);
    }
}

// A vertex is held by occlusive faces, by boundary faces that lie on no side of a box, and at the box's corners.
void find_kinds(MeshArrays& arrays)
{
    for (std::uint32_t t = 0; t < arrays.tets.size(); ++t)
        for (const std::uint32_t v : arrays.tets[t].vertices)
            if (arrays.states[t] == TetState::reached) arrays.kinds[v] = VertexKind::free;
    for (const Tet& tet : arrays.tets)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const auto vertices = face_vertices(tet, face);
            if (tet.faces[face] == FREE_FACE &&
                (tet.neighbours[face] != NO_HALF_FACE || common_sides(arrays, vertices) != 0))
                continue;
            for (const std::uint32_t v : vertices)
                arrays.kinds[v] = VertexKind::held;
        }
    for (std::size_t v = 0; v < arrays.points.size(); ++v)
        if (std::popcount(arrays.box_sides[v]) > 2) arrays.kinds[v] = VertexKind::held;
}

double face_area(const MeshArrays& arrays, std::uint32_t tet, std::uint32_t face)
{
    const auto [a, b, c] = face_vertices(arrays.tets[tet], face);
    return area(arrays.points[a], arrays.points[b], arrays.points[c]);
}

} // namespace

MeshArrays arrays_of(const TetMesh& mesh, bool all)
{
    MeshArrays arrays;
    arrays.tets = mesh.tets;
    arrays.states.assign(mesh.tets.size(), all ? TetState::reached : TetState::hidden);
    arrays.tet_changed.assign(mesh.tets.size(), 1);
    arrays.points.reserve(mesh.vertices.size());
    for (const Float3 vertex : mesh.vertices)
        arrays.points.push_back(to_double(vertex));
    arrays.kinds.assign(mesh.vertices.size(), VertexKind::held);
    arrays.box_sides.assign(mesh.vertices.size(), 0);
    arrays.vertex_changed.assign(mesh.vertices.size(), 1);
    if (!all) find_reached(arrays);
    find_box_sides(arrays);
    find_kinds(arrays);
    return arrays;
}

TetMesh mesh_of(const MeshArrays& arrays)
{
    TetMesh mesh;
    std::vector<std::uint32_t> vertex_place(arrays.points.size(), NO_TET), tet_place(arrays.tets.size(), 0);
    for (std::size_t t = 0; t < arrays.tets.size(); ++t) {
        if (arrays.states[t] == TetState::unused) continue;
        tet_place[t] = static_cast<std::uint32_t>(mesh.tets.size());
        mesh.tets.push_back(arrays.tets[t]);
        for (const std::uint32_t v : arrays.tets[t].vertices)
            vertex_place[v] = 0;
    }
    for (std::size_t v = 0; v < arrays.points.size(); ++v) {
        if (vertex_place[v] == NO_TET) continue;
        vertex_place[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(to_float(arrays.points[v]));
    }
    for (Tet& tet : mesh.tets)
        for (std::size_t i = 0; i < 4; ++i) {
            tet.vertices[i] = vertex_place[tet.vertices[i]];
            if (tet.neighbours[i] != NO_HALF_FACE)
                tet.neighbours[i] =
                    make_half_face(tet_place[half_face_tet(tet.neighbours[i])], half_face_index(tet.neighbours[i]));
        }
    return mesh;
}

double free_area(const MeshArrays& arrays)
{
    double sum = 0;
    for (std::uint32_t t = 0; t < arrays.tets.size(); ++t) {
        if (arrays.states[t] != TetState::reached) continue;
        const Tet& tet = arrays.tets[t];
        for (std::uint32_t face = 0; face < 4; ++face)
            if (tet.faces[face] == FREE_FACE && tet.neighbours[face] != NO_HALF_FACE &&
                half_face_tet(tet.neighbours[face]) > t)
                sum += face_area(arrays, t, face);
    }
    return sum;
}

double boundary_area(const MeshArrays& arrays)
{
    double sum = 0;
    for (std::uint32_t t = 0; t < arrays.tets.size(); ++t)
        for (std::uint32_t face = 0; face < 4; ++face)
            if (arrays.states[t] != TetState::unused && arrays.tets[t].neighbours[face] == NO_HALF_FACE)
                sum += face_area(arrays, t, face);
    return sum;
}

} // namespace tetrace
