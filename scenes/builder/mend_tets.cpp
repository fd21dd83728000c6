#include "scenes/builder/mend_tets.h"

#include "core/base/exact.h"
#include "scenes/builder/linked_tets.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>

// The condition for a collapse is that of Dey, Edelsbrunner, Guha, Nekhayev, "Topology preserving edge contraction",
// 1999: the links of the two vertices share the link of their edge, and no more.

namespace tetrace {
namespace {

constexpr float step_size = 0x1p-24f; // the spacing of floats in [1/2, 1)
constexpr int tries_of_cavity = 500, cavity_growth = 2;
constexpr std::uint64_t topology_cost = 32;            // of a tet, in tests
constexpr std::uint32_t max_cavities = 1000;           // of a mesh
constexpr std::uint64_t max_cavity_tests = 10'000'000; // of all of them
constexpr std::size_t max_cavity_size = 400;           // in tets
constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

using Direction = std::array<int, 3>;

// The 26 directions of a step, those along one axis first.
std::vector<Direction> directions()
{
    std::vector<Direction> result;
    for (int i = 0; i < 27; ++i)
        if (i != 13) result.push_back({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
    const auto axes = [](const Direction& d) { return d[0] * d[0] + d[1] * d[1] + d[2] * d[2]; };
    std::stable_sort(result.begin(), result.end(), [&](const auto& a, const auto& b) { return axes(a) < axes(b); });
    return result;
}

bool allowed(const Freedom& freedom, const Direction& direction)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0 && !freedom.axes[axis]) return false;
    return true;
}

std::uint32_t place_of(const Tet& tet, std::uint32_t vertex)
{
    return static_cast<std::uint32_t>(std::ranges::find(tet.vertices, vertex) - tet.vertices.begin());
}

bool has(const Tet& tet, std::uint32_t vertex)
{
    return place_of(tet, vertex) < 4;
}

// Vertices, edges and triangles, ascending.
using Simplices = std::set<std::array<std::uint32_t, 3>>;

// Adds the simplices of a tet's corners other than these two.
void add_simplices(const Tet& tet, std::uint32_t but, std::uint32_t and_but, Simplices& simplices)
{
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t corner : tet.vertices)
        if (corner != but && corner != and_but) rest.push_back(corner);
    std::ranges::sort(rest);
    for (unsigned chosen = 1; chosen < 1u << rest.size(); ++chosen) {
        std::array<std::uint32_t, 3> simplex = {nothing, nothing, nothing};
        for (std::size_t i = 0, n = 0; i < rest.size(); ++i)
            if ((chosen >> i & 1u) != 0) simplex[n++] = rest[i];
        simplices.insert(simplex);
    }
}

class TetMender {
public:
    TetMender(TetMesh& mesh, const std::vector<Freedom>& freedom, std::uint64_t tests)
        : mesh_(mesh), freedom_(freedom), links_(mesh), moves_left_(tests), removals_left_(tests)
    {
    }

    // Whether it changed anything.
    bool mend(const std::vector<std::uint32_t>& bad, bool may_remove)
    {
        const std::uint64_t before = done.moved_points + done.removed_points + done.refilled;
        for (const std::uint32_t tet : bad)
            if (!mend(tet, may_remove) && may_remove && is_there_and_bad(tet) && refill_around({tet})) ++done.refilled;
        return done.moved_points + done.removed_points + done.refilled > before;
    }
    [[nodiscard]] std::vector<std::uint32_t> bad_tets() const
    {
        std::vector<std::uint32_t> bad;
        for (std::uint32_t i = 0; i < mesh_.tets.size(); ++i)
            if (is_there_and_bad(i)) bad.push_back(i);
        return bad;
    }
    void drop_gone_tets() { links_.drop_gone(); }

    Rounding done;

private:
    // By one of its vertices. Whether there is one.
    bool mend(std::uint32_t tet, bool may_remove)
    {
        const std::array<std::uint32_t, 4> vertices = mesh_.tets[tet].vertices;
        bool changed = false;
        for (const std::uint32_t vertex : vertices) {
            if (freedom_[vertex].steps == 0 || !is_there_and_bad(tet)) continue;
            if (move(vertex))
                ++done.moved_points;
            else if (may_remove && remove(vertex))
                ++done.removed_points;
            else if (may_remove && cavities_ > 0 && refill_around(links_.star(vertex)))
                ++done.refilled;
            else
                continue;
            changed = true;
        }
        return changed;
    }
    [[nodiscard]] bool may_go(std::uint32_t vertex) const
    {
        return freedom_[vertex].steps > 0 && allowed(freedom_[vertex], {1, 1, 1});
    }
    [[nodiscard]] bool is_there_and_bad(std::uint32_t tet) const
    {
        return !links_.is_gone(tet) && is_bad(mesh_.tets[tet]);
    }
    [[nodiscard]] bool is_bad(const Tet& tet) const
    {
        const auto& [a, b, c, d] = tet.vertices;
        const auto& v = mesh_.vertices;
        return orientation(v[a], v[b], v[c], v[d]) >= 0;
    }
    // Counts up to `limit`, and takes what it spent from the budget. Tets with the corner `without` do not count.
    std::size_t count_bad(const std::vector<std::uint32_t>& tets, std::size_t limit, std::uint64_t& budget,
                          std::uint32_t without = nothing)
    {
        std::size_t bad = 0;
        for (std::size_t i = 0; i < tets.size() && bad < limit; ++i) {
            const Tet& tet = mesh_.tets[tets[i]];
            if (has(tet, without)) continue;
            bad += is_bad(tet) ? 1 : 0;
            budget -= budget > 0 ? 1 : 0;
        }
        return bad;
    }

    bool move(std::uint32_t vertex)
    {
        if (moves_left_ == 0) return false;
        static const auto all_directions = directions();
        const Freedom& freedom = freedom_[vertex];
        const Float3 home = mesh_.vertices[vertex];
        const auto around = links_.star(vertex);
        const std::size_t bad = count_bad(around, around.size(), moves_left_);
        for (std::uint32_t steps = 1; steps <= freedom.steps && moves_left_ > 0; steps *= 2) {
            for (const auto& direction : all_directions) {
                if (!allowed(freedom, direction)) continue;
                for (int axis = 0; axis < 3; ++axis)
                    mesh_.vertices[vertex][axis] =
                        snap_to_grid(home[axis] + static_cast<float>(direction[static_cast<std::size_t>(axis)]) *
                                                      static_cast<float>(steps) * step_size);
                if (count_bad(around, bad, moves_left_) < bad) return true;
            }
        }
        mesh_.vertices[vertex] = home;
        return false;
    }

    // Puts the vertex onto the neighbour that leaves the fewest bad tets, if these are fewer than now.
    bool remove(std::uint32_t vertex)
    {
        if (!may_go(vertex) || removals_left_ == 0) return false;
        const auto around = links_.star(vertex);
        const std::size_t bad = count_bad(around, around.size(), removals_left_);
        std::set<std::uint32_t> neighbours;
        for (const std::uint32_t tet : around)
            for (const std::uint32_t corner : mesh_.tets[tet].vertices)
                if (corner != vertex) neighbours.insert(corner);
        std::set<std::pair<std::size_t, std::uint32_t>> candidates;
        const Float3 home = mesh_.vertices[vertex];
        for (const std::uint32_t onto : neighbours) {
            mesh_.vertices[vertex] = mesh_.vertices[onto];
            candidates.emplace(removals_left_ > 0 ? count_bad(around, bad, removals_left_, onto) : bad, onto);
        }
        mesh_.vertices[vertex] = home;
        for (const auto& [left, onto] : candidates) {
            if (left >= bad || removals_left_ == 0) return false;
            removals_left_ -= std::min<std::uint64_t>(removals_left_, topology_cost * around.size());
            if (!keeps_surface(vertex, onto, around) || !keeps_topology(vertex, onto, around)) continue;
            collapse(vertex, onto, around);
            return true;
        }
        return false;
    }
    [[nodiscard]] bool keeps_topology(std::uint32_t vertex, std::uint32_t onto,
                                      const std::vector<std::uint32_t>& around) const
    {
        Simplices of_vertex, of_onto, of_edge, shared;
        for (const std::uint32_t tet : around) {
            add_simplices(mesh_.tets[tet], vertex, nothing, of_vertex);
            if (has(mesh_.tets[tet], onto)) add_simplices(mesh_.tets[tet], vertex, onto, of_edge);
        }
        for (const std::uint32_t tet : links_.star(onto))
            add_simplices(mesh_.tets[tet], onto, nothing, of_onto);
        std::ranges::set_intersection(of_vertex, of_onto, std::inserter(shared, shared.end()));
        return shared == of_edge;
    }

    // Of each neighbour of a vertex, the triangles of the occlusive faces that have both, once for each side of a face.
    using Labels = std::map<std::uint32_t, std::multiset<std::uint32_t>>;
    [[nodiscard]] Labels labels_at(std::uint32_t vertex, const std::vector<std::uint32_t>& around) const
    {
        Labels labels;
        for_each_occlusive_face(vertex, around, [&](std::uint32_t triangle, std::uint32_t a, std::uint32_t b) {
            labels[a].insert(triangle);
            labels[b].insert(triangle);
        });
        return labels;
    }
    template <class What>
    void for_each_occlusive_face(std::uint32_t vertex, const std::vector<std::uint32_t>& around, const What& what) const
    {
        for (const std::uint32_t index : around) {
            const Tet& tet = mesh_.tets[index];
            for (std::size_t face = 0; face < 4; ++face) {
                if (tet.faces[face] == FREE_FACE || tet.vertices[face] == vertex) continue;
                std::array<std::uint32_t, 2> others{};
                std::size_t n = 0;
                for (const std::uint32_t corner : face_corners[face])
                    if (tet.vertices[corner] != vertex) others[n++] = tet.vertices[corner];
                what(tet.faces[face], others[0], others[1]);
            }
        }
    }
    // Whether the faces of each triangle then cover the same of it, as near as rounding lets them.
    [[nodiscard]] bool keeps_surface(std::uint32_t vertex, std::uint32_t onto,
                                     const std::vector<std::uint32_t>& around) const
    {
        const Labels labels = labels_at(vertex, around);
        if (labels.empty()) return true;
        const auto along = labels.find(onto);
        if (along == labels.end()) return false;
        // Inside a triangle, two faces of that meet in an edge.
        const auto is_inside = [](const std::multiset<std::uint32_t>& at) {
            return at.size() == 4 && at.count(*at.begin()) == 4;
        };
        for (const auto& [other, at] : labels) {
            if (!is_inside(at) && is_inside(along->second)) return false;
            for (const std::uint32_t triangle : at)
                if (!along->second.contains(triangle)) return false;
        }
        for (const std::uint32_t index : around) { // two faces that become one
            const Tet& tet = mesh_.tets[index];
            if (has(tet, onto) && tet.faces[place_of(tet, vertex)] != FREE_FACE &&
                tet.faces[place_of(tet, onto)] != FREE_FACE)
                return false;
        }
        return !folds(vertex, onto, around);
    }
    [[nodiscard]] bool folds(std::uint32_t vertex, std::uint32_t onto, const std::vector<std::uint32_t>& around) const
    {
        bool folded = false;
        for_each_occlusive_face(vertex, around, [&](std::uint32_t, std::uint32_t a, std::uint32_t b) {
            const Double3 p = to_double(mesh_.vertices[a]), q = to_double(mesh_.vertices[b]);
            const auto normal = [&](std::uint32_t apex) { return cross(q - p, to_double(mesh_.vertices[apex]) - p); };
            if (a != onto && b != onto && dot(normal(vertex), normal(onto)) <= 0) folded = true;
        });
        return folded;
    }

    void collapse(std::uint32_t vertex, std::uint32_t onto, const std::vector<std::uint32_t>& around)
    {
        for (const std::uint32_t index : around) {
            const Tet& tet = mesh_.tets[index];
            if (!has(tet, onto)) continue;
            const std::uint32_t far = place_of(tet, vertex), near = place_of(tet, onto);
            const std::uint32_t triangle = tet.faces[far] != FREE_FACE ? tet.faces[far] : tet.faces[near];
            links_.join(tet.neighbours[far], tet.neighbours[near], triangle);
            links_.join(tet.neighbours[near], tet.neighbours[far], triangle);
            links_.remove(index);
        }
        for (const std::uint32_t index : around)
            if (!links_.is_gone(index)) links_.rename(index, vertex, onto);
    }
    // Refills these tets, or more around them.
    bool refill_around(std::vector<std::uint32_t> cavity)
    {
        for (int growth = 0; growth <= cavity_growth && cavity.size() <= max_cavity_size && cavities_ > 0; ++growth) {
            --cavities_;
            if (refill(cavity)) return true;
            cavity = links_.grown(cavity);
        }
        return false;
    }
    // Puts positive tets in the place of these, if there are some: their outer sides stay, and vertices inside that
    // may not move.
    bool refill(const std::vector<std::uint32_t>& cavity)
    {
        CavitySides sides = links_.sides_of(cavity);
        if (sides.empty()) return false;
        std::set<std::uint32_t> vertices, needed;
        for (const std::uint32_t index : cavity)
            vertices.insert(mesh_.tets[index].vertices.begin(), mesh_.tets[index].vertices.end());
        for (const std::uint32_t vertex : vertices)
            if (!may_go(vertex)) needed.insert(vertex);
        std::set<FaceSide> front;
        for (const auto& [side, across] : sides)
            front.insert(side);
        CavityFill fill(mesh_.vertices, std::move(front), std::move(vertices), tries_of_cavity, cavity_tests_);
        if (!fill.find(needed)) return false;
        links_.replace(cavity, std::move(sides), fill.tets());
        return true;
    }

    TetMesh& mesh_;
    const std::vector<Freedom>& freedom_;
    LinkedTets links_;
    std::uint64_t moves_left_, removals_left_, cavity_tests_ = max_cavity_tests; // tests
    std::uint32_t cavities_ = max_cavities;
};

} // namespace

Rounding mend_tets(TetMesh& mesh, const std::vector<Freedom>& freedom, std::uint64_t tests)
{
    constexpr int max_passes = 16, max_moving_passes = 6;
    TetMender mender(mesh, freedom, tests);
    auto bad = mender.bad_tets();
    mender.done.damaged = bad.size();
    bool may_remove = false;
    for (int pass = 0; pass < max_passes && !bad.empty(); ++pass) {
        const bool changed = mender.mend(bad, may_remove);
        bad = mender.bad_tets();
        if (!changed && may_remove) break;
        may_remove = may_remove || !changed || pass + 1 >= max_moving_passes;
    }
    mender.done.repaired = mender.done.damaged - bad.size();
    mender.drop_gone_tets();
    return mender.done;
}

} // namespace tetrace
