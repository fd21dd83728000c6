#include "scenes/optimise/edge_removal.h"

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

} // namespace

bool find_ring(const EditableMesh& mesh, std::uint32_t tet, std::uint32_t edge, std::size_t most, EdgeRing& ring)
{
    const auto& [a, b, c, d] = edge_first[edge];
    const Corners& corners = mesh.tet(tet).vertices;
    ring.a = corners[a];
    ring.b = corners[b];
    ring.tets.clear();
    ring.vertices.clear();
    std::uint32_t current = tet, back = c, front = corners[d];
    do {
        const Tet& here = mesh.tet(current);
        if (here.faces[back] != FREE_FACE || here.links[back] == NO_LINK || ring.tets.size() == most) return false;
        ring.tets.push_back(current);
        ring.vertices.push_back(here.vertices[back]);
        current = link_tet(here.links[back]);
        const std::uint32_t next = mesh.tet(current).vertices[link_face(here.links[back])];
        back = local_index(mesh.tet(current), front);
        front = next;
    } while (current != tet);
    return ring.tets.size() >= 3;
}

bool EdgeRemoval::is_first(std::uint32_t tet) const
{
    return std::none_of(ring_.tets.begin(), ring_.tets.end(),
                        [&](std::uint32_t other) { return other < tet && mesh_.tet_changed(other) >= since; });
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
    if (!find_ring(mesh_, tet, edge, most_around_edge, ring_) || !is_first(tet)) return 0;
    double before = 0;
    for (const std::uint32_t vertex : ring_.vertices)
        before += area(mesh_.point(ring_.a), mesh_.point(ring_.b), mesh_.point(vertex));
    const std::size_t last = ring_.vertices.size() - 1;
    triangulate(before - least);
    if (cost_[0][last] == impossible) return 0;
    fresh_.clear();
    emit(0, last);
    return mesh_.replace(ring_.tets, fresh_) ? before - cost_[0][last] : 0;
}

} // namespace tetrace
