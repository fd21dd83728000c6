#include "core/mesh/tet_mesh.h"

#include "core/base/exact.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

using Kind = TetMeshDefect::Kind;

// Collects the first defect of a kind and how many there are.
struct Finding {
    std::uint64_t first = 0, count = 0;

    void add(std::uint64_t index)
    {
        if (count++ == 0) first = index;
    }
    [[nodiscard]] TetMeshDefect defect(Kind kind, const std::string& text) const
    {
        return {kind, first, count,
                text + " (first: " + std::to_string(first) + ", " + std::to_string(count) + " in all)"};
    }
};

bool indices_exist(const TetMesh& mesh, const Tet& tet, std::size_t triangle_count)
{
    for (std::size_t i = 0; i < 4; ++i) {
        if (tet.vertices[i] >= mesh.vertices.size()) return false;
        if (tet.neighbours[i] != NO_HALF_FACE && half_face_tet(tet.neighbours[i]) >= mesh.tets.size()) return false;
        if (tet.faces[i] != FREE_FACE && tet.faces[i] >= triangle_count) return false;
    }
    return true;
}

std::array<std::uint32_t, 3> sorted_face(const Tet& tet, std::uint32_t face)
{
    std::array<std::uint32_t, 3> vertices{};
    for (std::uint32_t i = 0, n = 0; i < 4; ++i)
        if (i != face) vertices[n++] = tet.vertices[i];
    std::ranges::sort(vertices);
    return vertices;
}

bool neighbours_are_symmetric(const TetMesh& mesh, std::uint32_t index)
{
    const Tet& tet = mesh.tets[index];
    for (std::uint32_t face = 0; face < 4; ++face) {
        const std::uint32_t half_face = tet.neighbours[face];
        if (half_face == NO_HALF_FACE) continue;
        const Tet& other = mesh.tets[half_face_tet(half_face)];
        if (other.neighbours[half_face_index(half_face)] != make_half_face(index, face)) return false;
        if (sorted_face(other, half_face_index(half_face)) != sorted_face(tet, face)) return false;
    }
    return true;
}

bool faces_are_symmetric(const TetMesh& mesh, const Tet& tet)
{
    for (std::uint32_t face = 0; face < 4; ++face) {
        const std::uint32_t half_face = tet.neighbours[face];
        if (half_face != NO_HALF_FACE &&
            mesh.tets[half_face_tet(half_face)].faces[half_face_index(half_face)] != tet.faces[face])
            return false;
    }
    return true;
}

int orientation_of(const TetMesh& mesh, const Tet& tet)
{
    return orientation(mesh.vertices[tet.vertices[0]], mesh.vertices[tet.vertices[1]], mesh.vertices[tet.vertices[2]],
                       mesh.vertices[tet.vertices[3]]);
}

double area(Float3 a, Float3 b, Float3 c)
{
    return 0.5 * length(cross(to_double(b) - to_double(a), to_double(c) - to_double(a)));
}

double volume(const TetMesh& mesh, const Tet& tet)
{
    const Double3 origin = to_double(mesh.vertices[tet.vertices[0]]);
    const Double3 a = to_double(mesh.vertices[tet.vertices[1]]) - origin;
    const Double3 b = to_double(mesh.vertices[tet.vertices[2]]) - origin;
    const Double3 c = to_double(mesh.vertices[tet.vertices[3]]) - origin;
    return dot(a, cross(b, c)) / -6.0;
}

// Of each input triangle, the area of the occlusive faces that name it, each face once.
std::vector<double> covered_areas(const TetMesh& mesh, std::size_t triangle_count)
{
    std::vector<double> covered(triangle_count, 0.0);
    for (std::uint32_t index = 0; index < mesh.tets.size(); ++index) {
        const Tet& tet = mesh.tets[index];
        for (std::uint32_t face = 0; face < 4; ++face) {
            const bool counted_here =
                tet.neighbours[face] == NO_HALF_FACE || make_half_face(index, face) < tet.neighbours[face];
            if (tet.faces[face] == FREE_FACE || !counted_here) continue;
            const auto v = sorted_face(tet, face);
            covered[tet.faces[face]] += area(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]);
        }
    }
    return covered;
}

double perimeter(const TriangleMesh& mesh, std::size_t triangle)
{
    const auto& [ia, ib, ic] = mesh.triangles[triangle];
    const Double3 a = to_double(mesh.vertices[ia]), b = to_double(mesh.vertices[ib]), c = to_double(mesh.vertices[ic]);
    return length(b - a) + length(c - b) + length(a - c);
}

} // namespace

std::optional<TetMeshDefect> find_defect(const TetMesh& mesh, std::size_t triangle_count)
{
    Finding bad_index, asymmetric_neighbour, inverted, flat, asymmetric_face;
    if (mesh.tets.empty()) return TetMeshDefect{Kind::bad_index, 0, 0, "the mesh is empty"};
    if (mesh.tets.size() > MAX_TETS)
        return TetMeshDefect{Kind::bad_index, MAX_TETS, 1, "more tets than a link of 30 bits can name"};
    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i)
        if (!indices_exist(mesh, mesh.tets[i], triangle_count)) bad_index.add(i);
    if (bad_index.count > 0)
        return bad_index.defect(Kind::bad_index, "a tet names a vertex, tet or triangle that is not there");

    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i) {
        if (!neighbours_are_symmetric(mesh, i)) asymmetric_neighbour.add(i);
        if (!faces_are_symmetric(mesh, mesh.tets[i])) asymmetric_face.add(i);
        const int sign = orientation_of(mesh, mesh.tets[i]);
        if (sign > 0) inverted.add(i);
        if (sign == 0) flat.add(i);
    }
    if (asymmetric_neighbour.count > 0)
        return asymmetric_neighbour.defect(Kind::asymmetric_neighbour,
                                           "a tet's neighbour does not name it back over the same face");
    if (asymmetric_face.count > 0)
        return asymmetric_face.defect(Kind::asymmetric_face, "the two sides of a face name different input triangles");
    if (inverted.count > 0) return inverted.defect(Kind::inverted, "a tet is inverted");
    if (flat.count > 0) return flat.defect(Kind::flat, "a tet is flat");
    return std::nullopt;
}

std::optional<TetMeshDefect> find_gap(const TetMesh& mesh, const TriangleMesh& triangles, Double3 box_size)
{
    const double box_area = 2 * (box_size.x * box_size.y + box_size.y * box_size.z + box_size.z * box_size.x);
    const auto covered = covered_areas(mesh, triangles.triangles.size());
    Finding uncovered;
    for (std::size_t i = 0; i < covered.size(); ++i) {
        const auto& [a, b, c] = triangles.triangles[i];
        const double wanted = area(triangles.vertices[a], triangles.vertices[b], triangles.vertices[c]);
        // A Steiner point on an edge is rounded by up to 2^-21, which in a needle is much of the area.
        const double rounding = 0x1p-21 * perimeter(triangles, i);
        if (covered[i] == 0 || std::abs(covered[i] - wanted) > 1e-4 * wanted + 1e-12 * box_area + rounding)
            uncovered.add(i);
    }
    if (uncovered.count > 0)
        return uncovered.defect(Kind::uncovered_triangle,
                                "the faces that belong to an input triangle do not add up to its area");

    double sum = 0;
    for (const Tet& tet : mesh.tets)
        sum += volume(mesh, tet);
    const double box_volume = box_size.x * box_size.y * box_size.z;
    if (std::abs(sum - box_volume) > 1e-6 * box_volume)
        return TetMeshDefect{Kind::open_boundary, 0, 1,
                             "the tets' volumes sum to " + std::to_string(sum / box_volume) + " of the domain's"};
    return std::nullopt;
}

std::vector<bool> reached_tets(const TetMesh& mesh)
{
    std::vector<bool> reached(mesh.tets.size());
    std::vector<std::uint32_t> pending;
    const auto reach = [&](std::uint32_t tet) {
        if (!reached[tet]) pending.push_back(tet);
        reached[tet] = true;
    };
    for (std::uint32_t tet = 0; tet < mesh.tets.size(); ++tet)
        if (std::ranges::count(mesh.tets[tet].neighbours, NO_HALF_FACE) > 0) reach(tet);
    while (!pending.empty()) {
        const Tet& tet = mesh.tets[pending.back()];
        pending.pop_back();
        for (std::size_t face = 0; face < 4; ++face)
            if (tet.faces[face] == FREE_FACE && tet.neighbours[face] != NO_HALF_FACE)
                reach(half_face_tet(tet.neighbours[face]));
    }
    return reached;
}

TetMeshCounts count_faces(const TetMesh& mesh)
{
    TetMeshCounts counts;
    std::uint64_t inner_sides = 0;
    std::uint64_t occlusive_sides = 0;
    counts.tets = mesh.tets.size();
    for (const Tet& tet : mesh.tets) {
        for (std::size_t face = 0; face < 4; ++face) {
            const bool occlusive = tet.faces[face] != FREE_FACE;
            const bool boundary = tet.neighbours[face] == NO_HALF_FACE;
            if (boundary) ++counts.boundary_faces;
            if (boundary && occlusive) ++counts.occlusive_faces;
            if (!boundary) (occlusive ? occlusive_sides : inner_sides)++;
        }
    }
    counts.occlusive_faces += occlusive_sides / 2;
    counts.free_faces = inner_sides / 2;
    counts.reached_tets = static_cast<std::uint64_t>(std::ranges::count(reached_tets(mesh), true));
    return counts;
}

} // namespace tetrace
