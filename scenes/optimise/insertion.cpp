#include "scenes/optimise/insertion.h"

#include "core/mesh/tet_mesh.h"
#include "scenes/optimise/vertex_move.h"

#include <algorithm>

namespace tetrace {
namespace {

constexpr std::size_t max_ring = 24, max_in_cavity = 48;
constexpr int steps_past_best = 8, regrowths = 2, insertion_halvings = 5;
// What a try may lose, as parts of the free area inside the cavity, and still end well: before the vertex has moved,
// and after.
constexpr double max_loss_unmoved = 0.3, max_loss_moved = 0.15;

} // namespace

// Whether the tet of a point and a face may be made.
bool Insertion::sees(Double3 at, const Tet& tet, std::uint32_t face) const
{
    const auto& [i, j, k] = face_corners[face];
    return may_be_made(at, mesh_.point(tet.vertices[i]), mesh_.point(tet.vertices[j]), mesh_.point(tet.vertices[k]));
}

// Whether the vertex and an edge are to make a boundary face, which costs nothing.
bool Insertion::is_on_box(std::uint32_t p, std::uint32_t q) const
{
    return (mesh_.box_sides(p) & mesh_.box_sides(q) & sides_) != 0;
}

// Whether an outer face of the cavity is in the plane of a side that the vertex is to be on: it makes no tet.
bool Insertion::is_flush(const Tet& tet, std::uint32_t face) const
{
    const auto& [i, j, k] = face_corners[face];
    return tet.neighbours[face] == NO_HALF_FACE &&
           (mesh_.box_sides(tet.vertices[i]) & mesh_.box_sides(tet.vertices[j]) & mesh_.box_sides(tet.vertices[k]) &
            sides_) != 0;
}

// Half the areas of the three faces of a point and a face's edges: each is shared by two tets.
double Insertion::spokes(Double3 at, const Tet& tet, std::uint32_t face) const
{
    const auto& [i, j, k] = face_corners[face];
    const std::array<std::uint32_t, 4> v = {tet.vertices[i], tet.vertices[j], tet.vertices[k], tet.vertices[i]};
    double sum = 0;
    for (std::size_t n = 0; n < 3; ++n)
        if (!is_on_box(v[n], v[n + 1])) sum += area(at, mesh_.point(v[n]), mesh_.point(v[n + 1]));
    return 0.5 * sum;
}

double Insertion::face_area(const Tet& tet, std::uint32_t face) const
{
    const auto& [i, j, k] = face_corners[face];
    return area(mesh_.point(tet.vertices[i]), mesh_.point(tet.vertices[j]), mesh_.point(tet.vertices[k]));
}

double Insertion::change_by(Double3 at, std::uint32_t index) const
{
    const Tet& tet = mesh_.tet(index);
    double change = 0;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const std::uint32_t half_face = tet.neighbours[face];
        if (half_face != NO_HALF_FACE && mesh_.is_marked(half_face_tet(half_face))) {
            if (tet.faces[face] != FREE_FACE) return impossible;
            change -= spokes(at, tet, face) + face_area(tet, face);
        } else if (!is_flush(tet, face)) {
            if (!sees(at, tet, face)) return impossible;
            change += spokes(at, tet, face);
        }
    }
    return change;
}

void Insertion::add_neighbours(Double3 at, std::uint32_t index)
{
    const Tet& tet = mesh_.tet(index);
    for (std::uint32_t face = 0; face < 4; ++face) {
        if (tet.neighbours[face] == NO_HALF_FACE || tet.faces[face] != FREE_FACE) continue;
        const std::uint32_t other = half_face_tet(tet.neighbours[face]);
        if (mesh_.is_marked(other)) continue;
        const double change = change_by(at, other);
        const auto known = std::find_if(candidates_.begin(), candidates_.end(),
                                        [&](const Candidate& candidate) { return candidate.tet == other; });
        if (known != candidates_.end())
            known->change = change;
        else
            candidates_.push_back({other, change});
    }
}

// Grows the cavity from the tets in it; returns the cost of its inside with the vertex, less its cost now.
double Insertion::grow(Double3 at)
{
    mesh_.unmark_all();
    candidates_.clear();
    double cost = 0;
    for (const std::uint32_t t : cavity_)
        mesh_.mark(t);
    for (const std::uint32_t t : cavity_) {
        const Tet& tet = mesh_.tet(t);
        for (std::uint32_t face = 0; face < 4; ++face) {
            const std::uint32_t half_face = tet.neighbours[face];
            if (half_face != NO_HALF_FACE && mesh_.is_marked(half_face_tet(half_face))) {
                if (tet.faces[face] != FREE_FACE) return impossible;
                cost -= 0.5 * face_area(tet, face);
            } else if (!is_flush(tet, face)) {
                if (!sees(at, tet, face)) return impossible;
                cost += spokes(at, tet, face);
            }
        }
    }
    for (const std::uint32_t t : cavity_)
        add_neighbours(at, t);
    double best = cost;
    std::size_t best_size = cavity_.size();
    for (int past = 0; past < steps_past_best && cavity_.size() < max_in_cavity && !candidates_.empty(); ++past) {
        const auto next = std::min_element(candidates_.begin(), candidates_.end(),
                                           [](const Candidate& a, const Candidate& b) { return a.change < b.change; });
        if (next->change == impossible) break;
        const std::uint32_t tet = next->tet;
        cost += next->change;
        *next = candidates_.back();
        candidates_.pop_back();
        mesh_.mark(tet);
        cavity_.push_back(tet);
        add_neighbours(at, tet);
        if (cost < best) {
            best = cost;
            best_size = cavity_.size();
            past = -1;
        }
    }
    cavity_.resize(best_size);
    return best;
}

// The outer faces of the cavity that make tets, the edges of them that make free faces, and the area inside.
void Insertion::find_outside()
{
    mesh_.unmark_all();
    for (const std::uint32_t t : cavity_)
        mesh_.mark(t);
    faces_.clear();
    outside_.edges.clear();
    inside_area_ = 0;
    for (const std::uint32_t t : cavity_) {
        const Tet& tet = mesh_.tet(t);
        for (std::uint32_t face = 0; face < 4; ++face) {
            if (tet.neighbours[face] != NO_HALF_FACE && mesh_.is_marked(half_face_tet(tet.neighbours[face]))) {
                inside_area_ += 0.5 * face_area(tet, face);
                continue;
            }
            if (is_flush(tet, face)) continue;
            const auto& [i, j, k] = face_corners[face];
            const std::array<std::uint32_t, 3> v = {tet.vertices[i], tet.vertices[j], tet.vertices[k]};
            faces_.push_back(v);
            for (std::size_t n = 0; n < 3; ++n) // each edge has two faces, which run along it in opposite ways
                if (v[n] < v[(n + 1) % 3] && !is_on_box(v[n], v[(n + 1) % 3]))
                    outside_.edges.push_back({v[n], v[(n + 1) % 3], NO_TET, NO_TET});
        }
    }
}

bool Insertion::may_be_at(Double3 at) const
{
    return std::all_of(faces_.begin(), faces_.end(), [&](const std::array<std::uint32_t, 3>& v) {
        return may_be_made(at, mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]));
    });
}

Double3 Insertion::better_point(Double3 at) const
{
    const Double3 way = cheapest_point(mesh_, outside_.edges, sides_, at, 3) - at;
    const double now = outside_.cost(mesh_, at);
    double part = 1;
    for (int i = 0; i < insertion_halvings; ++i, part /= 2) {
        const Double3 to = rounded_point(at + way * part);
        if (outside_.cost(mesh_, to) < now && may_be_at(to)) return to;
    }
    return at;
}

double Insertion::ring_area() const
{
    double sum = 0;
    for (const std::uint32_t v : ring_.vertices)
        sum += area(mesh_.point(ring_.a), mesh_.point(ring_.b), mesh_.point(v));
    return sum;
}

double Insertion::try_edge(std::uint32_t tet, std::uint32_t edge, double least)
{
    if (!find_ring(mesh_, tet, edge, max_ring, since, ring_)) return 0;
    sides_ = ring_.is_open() ? mesh_.box_sides(ring_.a) & mesh_.box_sides(ring_.b) : 0;
    if (ring_.is_open() && sides_ == 0) return 0; // the domain is not a box
    if (ring_area() < min_ring_area) return 0;
    Double3 at = rounded_point((mesh_.point(ring_.a) + mesh_.point(ring_.b)) * 0.5);
    cavity_ = ring_.tets;
    double gain = 0;
    for (int i = 0; i <= regrowths; ++i) {
        const double loss = grow(at);
        if (loss == impossible) return 0;
        find_outside();
        if (loss + least > max_loss_unmoved * inside_area_) return 0;
        at = better_point(at);
        gain = inside_area_ - outside_.cost(mesh_, at);
        if (least - gain > max_loss_moved * inside_area_) return 0;
    }
    if (gain <= least + min_share * inside_area_ || !may_be_at(at)) return 0;
    const std::uint32_t vertex = mesh_.add_vertex(at, sides_);
    fresh_.clear();
    for (const auto& [p, q, r] : faces_)
        fresh_.push_back({vertex, p, q, r});
    if (mesh_.replace(cavity_, fresh_)) return gain;
    mesh_.drop_vertex(vertex);
    return 0;
}

} // namespace tetrace
