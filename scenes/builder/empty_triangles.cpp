#include "scenes/builder/empty_triangles.h"

#include "scenes/builder/triple_hash.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>

namespace tetrace {

namespace {

using CornerPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Corners = std::array<std::uint32_t, 3>;

class NeighbourSplitter {
public:
    NeighbourSplitter(TriangleMesh& mesh, std::vector<std::uint32_t>& origins) : mesh_(mesh), origins_(origins) {}

    std::uint64_t split_all()
    {
        find_empty();
        if (open_.empty()) return 0;
        find_edges();
        // The longest first: an empty neighbour is as long at most, and its pieces are shorter, so this ends. The bound
        // is for chains of very many.
        const std::uint64_t max_splits = 16 * open_.size() + 1000;
        std::uint64_t splits = 0;
        while (!open_.empty() && splits < max_splits) {
            const std::size_t empty = open_.top().second;
            open_.pop();
            splits += split_neighbours(empty);
        }
        return splits;
    }

private:
    using Edge = std::pair<std::uint32_t, std::uint32_t>;

    [[nodiscard]] CornerPoint point(std::uint32_t vertex) const
    {
        const Double3 v = to_double(mesh_.vertices[vertex]);
        return {v.x, v.y, v.z};
    }
    // With its longest edge from the first corner to the last, if it has no area, and three different corners.
    [[nodiscard]] std::optional<Corners> along_line(const Corners& triangle) const
    {
        const auto [a, b, c] = triangle;
        const CornerPoint p = point(a), q = point(b), r = point(c);
        if (p == q || q == r || r == p || !CGAL::collinear(p, q, r)) return std::nullopt;
        if (CGAL::collinear_are_ordered_along_line(p, q, r)) return Corners{a, b, c};
        return CGAL::collinear_are_ordered_along_line(q, r, p) ? Corners{b, c, a} : Corners{c, a, b};
    }
    void add_if_empty(std::size_t triangle)
    {
        const auto line = along_line(mesh_.triangles[triangle]);
        if (!line) return;
        const Double3 side = to_double(mesh_.vertices[line->back()]) - to_double(mesh_.vertices[line->front()]);
        open_.emplace(dot(side, side), triangle);
    }
    void find_empty()
    {
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
            add_if_empty(i);
    }

    // Of all triangles, those edges that join the places of empty triangles' corners.
    void find_edges()
    {
        for (auto rest = open_; !rest.empty(); rest.pop())
            for (const std::uint32_t vertex : mesh_.triangles[rest.top().second])
                places_.try_emplace(bits_at(vertex), static_cast<std::uint32_t>(places_.size()));
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
            add_edges(i);
    }
    [[nodiscard]] Corners bits_at(std::uint32_t vertex) const
    {
        const Float3 v = mesh_.vertices[vertex];
        return {std::bit_cast<std::uint32_t>(v.x + 0.0f), std::bit_cast<std::uint32_t>(v.y + 0.0f),
                std::bit_cast<std::uint32_t>(v.z + 0.0f)};
    }
    [[nodiscard]] std::optional<Edge> edge_between(std::uint32_t a, std::uint32_t b) const
    {
        const auto first = places_.find(bits_at(a)), second = places_.find(bits_at(b));
        if (first == places_.end() || second == places_.end()) return std::nullopt;
        return std::minmax(first->second, second->second);
    }
    void add_edges(std::size_t triangle)
    {
        const Corners corners = mesh_.triangles[triangle];
        for (std::size_t i = 0; i < 3; ++i)
            if (const auto edge = edge_between(corners[i], corners[(i + 1) % 3])) edges_[*edge].push_back(triangle);
    }

    std::uint64_t split_neighbours(std::size_t empty)
    {
        const auto line = along_line(mesh_.triangles[empty]);
        if (!line) return 0; // it was split
        const auto longest = edge_between(line->front(), line->back());
        std::uint64_t splits = 0;
        const std::vector<std::size_t> neighbours = std::exchange(edges_[*longest], {});
        for (const std::size_t neighbour : neighbours)
            if (neighbour != empty && split(neighbour, *longest, (*line)[1])) ++splits;
        mesh_.triangles[empty].fill((*line)[1]); // its two other edges are its neighbours' now
        return splits;
    }
    bool split(std::size_t triangle, const Edge& edge, std::uint32_t middle)
    {
        const Corners corners = mesh_.triangles[triangle];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = corners[i], to = corners[(i + 1) % 3], tip = corners[(i + 2) % 3];
            if (edge_between(from, to) != edge) continue;
            mesh_.triangles[triangle] = {from, middle, tip};
            mesh_.triangles.push_back({middle, to, tip});
            origins_.push_back(origins_[triangle]);
            for (const std::size_t piece : {triangle, mesh_.triangles.size() - 1}) {
                add_edges(piece);
                add_if_empty(piece);
            }
            return true;
        }
        return false; // it was split before
    }

    TriangleMesh& mesh_;
    std::vector<std::uint32_t>& origins_;
    std::priority_queue<std::pair<double, std::size_t>> open_; // empty triangles by the square of the longest edge
    std::unordered_map<Corners, std::uint32_t, TripleHash> places_;
    std::map<Edge, std::vector<std::size_t>> edges_;
};

} // namespace

std::uint64_t split_at_empty_triangles(TriangleMesh& mesh, std::vector<std::uint32_t>& origins)
{
    return NeighbourSplitter(mesh, origins).split_all();
}

} // namespace tetrace
