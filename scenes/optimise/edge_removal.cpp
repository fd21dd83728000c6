#include "scenes/optimise/edge_removal.h"

#include "core/mesh/tet_mesh.h"
#include "scenes/optimise/shape.h"

#include <algorithm>

namespace tetrace {
namespace {

// Even permutations of a tet's vertices, one for each edge: the edge first.
constexpr std::array<std::array<std::uint32_t, 4>, 6> edge_first = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

std::uint32_t local_index(const Tet& tet, std::uint32_t vertex)
{
    for (std::uint32_t i = 0; i < 3; ++i)
        if (tet.vertices[i] == vertex) return i;
    return 3;
}

// A tet of the ring: its ring vertices at the back and the front, by their local numbers.
struct RingTet {
    std::uint32_t tet, back, front;
};

RingTet next_of(const EditableMesh& mesh, const RingTet& at)
{
    const Tet& here = mesh.tet(at.tet);
    const std::uint32_t half_face = here.neighbours[at.back], tet = half_face_tet(half_face);
    return {tet, local_index(mesh.tet(tet), here.vertices[at.front]), half_face_index(half_face)};
}

enum class RingEnd { closed, at_boundary, refused };

// A tet from which the edge is looked at, too, and before the one where the search began.
struct Earlier {
    std::uint32_t tet, since;

    [[nodiscard]] bool has(const EditableMesh& mesh, std::uint32_t other) const
    {
        return other < tet && mesh.tet_changed(other) >= since;
    }
};

RingEnd follow(const EditableMesh& mesh, const RingTet& begin, std::size_t most, const Earlier& earlier, EdgeRing& ring)
{
    ring.tets.clear();
    ring.vertices.clear();
    RingTet at = begin;
    do {
        const Tet& here = mesh.tet(at.tet);
        if (here.faces[at.back] != FREE_FACE || ring.vertices.size() == most || earlier.has(mesh, at.tet))
            return RingEnd::refused;
        ring.tets.push_back(at.tet);
        ring.vertices.push_back(here.vertices[at.back]);
        if (here.neighbours[at.back] == NO_HALF_FACE) {
            ring.vertices.push_back(here.vertices[at.front]);
            return ring.vertices.size() <= most ? RingEnd::at_boundary : RingEnd::refused;
        }
        at = next_of(mesh, at);
    } while (at.tet != begin.tet);
    return RingEnd::closed;
}

} // namespace

bool find_ring(const EditableMesh& mesh, std::uint32_t tet, std::uint32_t edge, std::size_t most, std::uint32_t since,
               EdgeRing& ring)
{
    const auto& [a, b, c, d] = edge_first[edge];
    const Corners& corners = mesh.tet(tet).vertices;
    ring.a = corners[a];
    ring.b = corners[b];
    const Earlier earlier{tet, since};
    const RingEnd end = follow(mesh, {tet, c, d}, most, earlier, ring);
    if (end != RingEnd::at_boundary) return end == RingEnd::closed && ring.tets.size() >= 3;
    RingTet begin{tet, d, c}; // looking back, from the start of the ring
    for (std::size_t i = 0; mesh.tet(begin.tet).neighbours[begin.back] != NO_HALF_FACE; ++i) {
        if (mesh.tet(begin.tet).faces[begin.back] != FREE_FACE || i == most || earlier.has(mesh, begin.tet))
            return false;
        begin = next_of(mesh, begin);
    }
    if (mesh.tet(begin.tet).faces[begin.back] != FREE_FACE) return false;
    return follow(mesh, {begin.tet, begin.front, begin.back}, most, earlier, ring) == RingEnd::at_boundary &&
           ring.tets.size() >= 2;
}

// Whether the boundary faces at an open ring's ends lie on one side of the box.
bool EdgeRemoval::ends_on_one_side() const
{
    return (mesh_.box_sides(ring_.a) & mesh_.box_sides(ring_.b) & mesh_.box_sides(ring_.vertices.front()) &
            mesh_.box_sides(ring_.vertices.back())) != 0;
}

// Parts that cost `limit` or more stay impossible.
void EdgeRemoval::triangulate(double limit)
{
    const std::size_t n = ring_.vertices.size();
    const Double3 a = mesh_.point(ring_.a), b = mesh_.point(ring_.b);
    for (std::size_t i = 0; i + 1 < n; ++i)
        cost_[i][i + 1] = 0;
    for (std::size_t length = 2; length < n; ++length)
        for (std::size_t i = 0; i + length < n; ++i) {
            const std::size_t k = i + length;
            const Double3 first = ring_point(i), last = ring_point(k);
            const double chord = length == n - 1 ? 0 : area(a, first, last) + area(b, first, last);
            double best = limit;
            cost_[i][k] = impossible;
            for (std::size_t j = i + 1; j < k; ++j) {
                double cost = cost_[i][j] + cost_[j][k] + chord;
                if (cost >= best) continue;
                const Double3 middle = ring_point(j);
                cost += area(first, middle, last);
                if (cost >= best || !may_be_made(a, first, middle, last) || !may_be_made(b, first, last, middle))
                    continue;
                best = cost_[i][k] = cost;
                middle_[i][k] = j;
            }
        }
}

void EdgeRemoval::emit(std::size_t i, std::size_t k)
{
    if (k - i < 2) return;
    const std::size_t j = middle_[i][k];
    const auto& ring = ring_.vertices;
    fresh_.push_back({ring_.a, ring[i], ring[j], ring[k]});
    fresh_.push_back({ring_.b, ring[i], ring[k], ring[j]});
    emit(i, j);
    emit(j, k);
}

double EdgeRemoval::try_edge(std::uint32_t tet, std::uint32_t edge, double least)
{
    if (!find_ring(mesh_, tet, edge, max_around_edge, since, ring_)) return 0;
    const std::size_t last = ring_.vertices.size() - 1, open = ring_.is_open() ? 1 : 0;
    if (open == 1 && !ends_on_one_side()) return 0;
    double before = 0; // the free faces: those of an open ring's ends are on the boundary
    for (std::size_t i = open; i <= last - open; ++i)
        before += area(mesh_.point(ring_.a), mesh_.point(ring_.b), ring_point(i));
    triangulate(before - least);
    if (cost_[0][last] == impossible) return 0;
    fresh_.clear();
    emit(0, last);
    return mesh_.replace(ring_.tets, fresh_) ? before - cost_[0][last] : 0;
}

double try_face(EditableMesh& mesh, std::uint32_t tet, std::uint32_t face, double least)
{
    const Tet& here = mesh.tet(tet);
    const std::uint32_t half_face = here.neighbours[face];
    if (half_face == NO_HALF_FACE || here.faces[face] != FREE_FACE) return 0;
    const std::uint32_t a = here.vertices[face],
                        b = mesh.tet(half_face_tet(half_face)).vertices[half_face_index(half_face)];
    const auto& [i, j, k] = face_corners[face];
    const std::uint32_t p = here.vertices[i], q = here.vertices[j], r = here.vertices[k];
    double gain = area(mesh.point(p), mesh.point(q), mesh.point(r));
    for (const std::uint32_t corner : {p, q, r}) {
        gain -= area(mesh.point(a), mesh.point(b), mesh.point(corner));
        if (gain <= least) return 0;
    }
    const std::array<std::uint32_t, 2> old = {tet, half_face_tet(half_face)};
    const std::array<Corners, 3> fresh = {{{a, b, p, q}, {a, b, q, r}, {a, b, r, p}}};
    return mesh.replace(old, fresh) ? gain : 0;
}

} // namespace tetrace
