#include "scenes/optimise/collapse.h"

#include <algorithm>

namespace tetrace {
namespace {

constexpr std::size_t max_collapsed_tets = 200;

} // namespace

// A face of the vertex and a link edge stays as a face of `onto` and the edge, unless a tet next to it vanishes.
double Collapse::cost_after(std::uint32_t onto, double limit) const
{
    double sum = 0;
    const Double3 at = mesh_.point(onto);
    for (const auto& edge : star_.edges) {
        if (edge.p == onto || edge.q == onto || edge.left == onto || edge.right == onto) continue;
        sum += area(at, mesh_.point(edge.p), mesh_.point(edge.q));
        if (sum >= limit) return impossible;
    }
    return sum;
}

// Neighbours on all sides of the box that the vertex is on, and for which cost is below the limit, cheapest first.
void Collapse::find_candidates(std::uint32_t vertex, double limit)
{
    neighbours_.clear();
    for (const std::uint32_t t : star_.tets)
        for (const std::uint32_t v : mesh_.tet(t).vertices)
            if (v != vertex && (mesh_.box_sides(vertex) & ~mesh_.box_sides(v)) == 0) neighbours_.push_back(v);
    std::sort(neighbours_.begin(), neighbours_.end());
    neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
    candidates_.clear();
    for (const std::uint32_t onto : neighbours_) {
        const double cost = cost_after(onto, limit);
        if (cost < limit) candidates_.push_back({cost, onto});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.vertex < b.vertex;
    });
}

void Collapse::make_fresh(std::uint32_t vertex, std::uint32_t onto)
{
    fresh_.clear();
    for (const std::uint32_t t : star_.tets) {
        Corners corners = mesh_.tet(t).vertices;
        if (std::find(corners.begin(), corners.end(), onto) != corners.end()) continue;
        std::replace(corners.begin(), corners.end(), vertex, onto);
        fresh_.push_back(corners);
    }
}

double Collapse::try_vertex(std::uint32_t vertex, double least)
{
    if (!find_star(mesh_, vertex, max_collapsed_tets, star_)) return 0;
    const double before = star_.cost(mesh_, mesh_.point(vertex));
    find_candidates(vertex, before - least);
    for (const Candidate& candidate : candidates_) {
        make_fresh(vertex, candidate.vertex);
        const bool possible = std::all_of(fresh_.begin(), fresh_.end(), [&](const Corners& c) {
            return may_be_made(mesh_.point(c[0]), mesh_.point(c[1]), mesh_.point(c[2]), mesh_.point(c[3]));
        });
        if (possible && mesh_.replace(star_.tets, fresh_)) return before - candidate.cost;
    }
    return 0;
}

} // namespace tetrace
