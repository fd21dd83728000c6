#include "scenes/builder/repair/contacts.h"

#include "core/base/exact.h"
#include "scenes/builder/triple_hash.h"

#include <CGAL/Bbox_3.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

namespace tetrace {
namespace {

using Triple = std::array<std::uint32_t, 3>;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

bool has(const Triple& triangle, std::uint32_t vertex)
{
    return std::ranges::find(triangle, vertex) != triangle.end();
}

// The places of a mesh's vertices, no two of them nearer than the tolerance.
class Places {
public:
    explicit Places(double tolerance) : tolerance_(tolerance) {}

    // The first place within the tolerance, or this one.
    std::uint32_t find_or_add(Float3 point)
    {
        std::uint32_t first = none;
        for (int i = 0; i < 27; ++i) {
            const auto cell = cells_.find(cell_of(point, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}));
            if (cell == cells_.end()) continue;
            for (const std::uint32_t place : cell->second)
                if (place < first && length(to_double(points[place]) - to_double(point)) <= tolerance_) first = place;
        }
        if (first != none) return first;
        add(point);
        return static_cast<std::uint32_t>(points.size() - 1);
    }

    void add(Float3 point)
    {
        cells_[cell_of(point, {0, 0, 0})].push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(point);
    }

    std::vector<Float3> points;

private:
    using Cell = std::array<std::int64_t, 3>;
    [[nodiscard]] Cell cell_of(Float3 point, const std::array<int, 3>& step) const
    {
        Cell cell;
        for (int axis = 0; axis < 3; ++axis)
            cell[static_cast<std::size_t>(axis)] =
                static_cast<std::int64_t>(std::floor(static_cast<double>(point[axis]) / tolerance_)) +
                step[static_cast<std::size_t>(axis)];
        return cell;
    }

    double tolerance_;
    std::unordered_map<Cell, std::vector<std::uint32_t>, TripleHash> cells_;
};

// The slab of a triangle's plane and the lines of its sides in it, to see quickly that another triangle is away.
class Slab {
public:
    Slab(Double3 a, Double3 b, Double3 c)
    {
        const Double3 across = cross(b - a, c - a);
        const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
        if (length(across) < 0x1p-20 * longest) return; // of a sliver, double precision has no sound plane
        const Double3 normal = normalized(across);
        add(normal, a), add(normal * -1.0, a);
        add(normalized(cross(b - a, normal)), a), add(normalized(cross(c - b, normal)), b);
        add(normalized(cross(a - c, normal)), c);
    }
    // Whether all corners are further than that beyond one of its bounds.
    [[nodiscard]] bool excludes(const std::array<Double3, 3>& corners, double distance) const
    {
        return std::any_of(bounds_.begin(), bounds_.begin() + count_, [&](const Bound& bound) {
            return std::ranges::all_of(
                corners, [&](Double3 corner) { return dot(bound.outwards, corner) - bound.offset > distance; });
        });
    }

private:
    struct Bound {
        Double3 outwards;
        double offset;
    };
    void add(Double3 outwards, Double3 through) { bounds_[count_++] = {outwards, dot(outwards, through)}; }

    std::array<Bound, 5> bounds_{};
    std::uint32_t count_ = 0;
};

class ContactFinder {
public:
    ContactFinder(TriangleMesh& mesh, double tolerance, const std::vector<bool>& chosen)
        : mesh_(mesh), places_(tolerance / 2), tolerance_(tolerance), chosen_(chosen)
    {
        for (const Float3 vertex : mesh.vertices)
            places_.add(vertex);
        contacts_.in_triangles.resize(mesh.triangles.size());
        contacts_.near_triangles.resize(mesh.triangles.size());
    }

    Contacts find()
    {
        const std::vector<Edge> pairs = near_pairs();
        for (const auto& [a, b] : pairs) {
            contacts_.near_triangles[a].push_back(b);
            contacts_.near_triangles[b].push_back(a);
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    meet(side_of(mesh_.triangles[a], i), side_of(mesh_.triangles[b], k));
            pierce(a, b);
            pierce(b, a);
        }
        attach_vertices();
        mesh_.vertices = std::move(places_.points);
        return std::move(contacts_);
    }

private:
    using GrownBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

    [[nodiscard]] CGAL::Bbox_3 grown_box(std::uint32_t triangle, double by) const
    {
        CGAL::Bbox_3 box;
        const double r = by * tolerance_;
        for (const std::uint32_t corner : mesh_.triangles[triangle]) {
            const Double3 p = at(corner);
            box += CGAL::Bbox_3(p.x - r, p.y - r, p.z - r, p.x + r, p.y + r, p.z + r);
        }
        return box;
    }
    [[nodiscard]] std::vector<Edge> near_pairs() const
    {
        std::vector<GrownBox> boxes;
        std::vector<Slab> slabs;
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            const auto [a, b, c] = corners(i);
            slabs.emplace_back(a, b, c);
            if (chosen_[i]) boxes.emplace_back(grown_box(i, 0.51), i);
        }
        // A vertex near both may be between them.
        const double away = 2.1 * tolerance_;
        std::vector<Edge> pairs;
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const GrownBox& a, const GrownBox& b) {
            if (!slabs[a.info()].excludes(corners(b.info()), away) &&
                !slabs[b.info()].excludes(corners(a.info()), away))
                pairs.push_back(edge_of(a.info(), b.info()));
        });
        std::ranges::sort(pairs);
        return pairs;
    }

    [[nodiscard]] std::array<Double3, 3> corners(std::uint32_t triangle) const
    {
        const auto [a, b, c] = mesh_.triangles[triangle];
        return {at(a), at(b), at(c)};
    }
    [[nodiscard]] Double3 at(std::uint32_t vertex) const { return to_double(places_.points[vertex]); }

    void add_to(const Edge& edge, std::uint32_t vertex)
    {
        if (vertex == edge.first || vertex == edge.second) return;
        auto& list = contacts_.on_edges[edge];
        if (std::ranges::find(list, vertex) != list.end()) return;
        list.push_back(vertex);
    }
    void add_vertex(Double3 point) { places_.find_or_add(snap_to_grid(to_float(point))); }

    // Whether it is near the edge between its ends. It is not one of these, and not near one.
    [[nodiscard]] bool is_near(std::uint32_t vertex, const Edge& edge) const
    {
        if (vertex == edge.first || vertex == edge.second) return false;
        const Double3 from = at(edge.first), along = at(edge.second) - from, to = at(vertex) - from;
        const double share = dot(to, along) / dot(along, along);
        return share > 0 && share < 1 && length(to - along * share) <= tolerance_;
    }
    struct Seen {
        double height; // above the plane
        double inside; // least distance to the sides' lines, in the plane; positive inside
    };
    [[nodiscard]] Seen seen_from(const Triple& triangle, Double3 point) const
    {
        const Double3 a = at(triangle[0]), b = at(triangle[1]), c = at(triangle[2]);
        const Double3 normal = normalized(cross(b - a, c - a));
        const auto beside = [&](Double3 p, Double3 q) { return dot(cross(normal, q - p), point - p) / length(q - p); };
        return {dot(normal, point - a), std::min({beside(a, b), beside(b, c), beside(c, a)})};
    }
    [[nodiscard]] bool is_near(std::uint32_t vertex, const Triple& triangle) const
    {
        const Seen seen = seen_from(triangle, at(vertex));
        return seen.inside > 0 && std::abs(seen.height) <= tolerance_;
    }
    void attach_vertices()
    {
        std::vector<GrownBox> points, triangles;
        for (std::uint32_t i = 0; i < places_.points.size(); ++i) {
            const Double3 p = at(i);
            points.emplace_back(CGAL::Bbox_3(p.x, p.y, p.z, p.x, p.y, p.z), i);
        }
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
            if (chosen_[i]) triangles.emplace_back(grown_box(i, 1.01), i);
        std::vector<Edge> near; // vertex, triangle
        CGAL::box_intersection_d(points.begin(), points.end(), triangles.begin(), triangles.end(),
                                 [&](const GrownBox& a, const GrownBox& b) { near.emplace_back(a.info(), b.info()); });
        std::ranges::sort(near);
        for (const auto& [vertex, triangle] : near)
            attach(vertex, triangle);
    }
    void attach(std::uint32_t vertex, std::uint32_t number)
    {
        const Triple& triangle = mesh_.triangles[number];
        bool on_edge = false;
        for (std::size_t i = 0; i < 3; ++i)
            if (is_near(vertex, side_of(triangle, i))) {
                add_to(side_of(triangle, i), vertex);
                on_edge = true;
            }
        if (!on_edge && !has(triangle, vertex) && is_near(vertex, triangle)) add_inside(number, vertex);
    }
    void add_inside(std::uint32_t triangle, std::uint32_t vertex)
    {
        auto& list = contacts_.in_triangles[triangle];
        if (std::ranges::find(list, vertex) != list.end()) return;
        list.push_back(vertex);
    }

    // Two edges that pass each other between their ends.
    void meet(const Edge& e, const Edge& f)
    {
        if (e.first == f.first || e.first == f.second || e.second == f.first || e.second == f.second) return;
        if (!met_.insert(std::minmax(e, f)).second) return;
        const Double3 p = at(e.first), u = at(e.second) - p, q = at(f.first), v = at(f.second) - q, w = p - q;
        const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
        const double scale = uu * vv - uv * uv;
        if (scale <= 1e-24 * uu * vv) return; // parallel: what is near are ends
        const double s = (uv * vw - vv * uw) / scale, t = (uu * vw - uv * uw) / scale;
        if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) return;
        const Double3 on_e = p + u * s, on_f = q + v * t;
        if (length(on_e - on_f) > tolerance_) return;
        add_vertex((on_e + on_f) * 0.5);
    }

    // Edges of one triangle that cross the other inside it.
    void pierce(std::uint32_t from, std::uint32_t to)
    {
        const Triple triangle = mesh_.triangles[to];
        for (std::size_t i = 0; i < 3; ++i) {
            const Edge edge = side_of(mesh_.triangles[from], i);
            const Double3 p = at(edge.first), q = at(edge.second);
            const double above = seen_from(triangle, p).height, below = seen_from(triangle, q).height;
            if (above * below >= 0) continue;
            const Double3 point = p + (q - p) * (above / (above - below));
            if (seen_from(triangle, point).inside > 0) add_vertex(point);
        }
    }

    TriangleMesh& mesh_;
    Places places_;
    double tolerance_;
    const std::vector<bool>& chosen_;
    Contacts contacts_;
    std::set<std::pair<Edge, Edge>> met_;
};

} // namespace

void merge_near_vertices(TriangleMesh& mesh, double distance, const std::vector<bool>& chosen)
{
    std::vector<bool> is_chosen(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[i])
            if (chosen[i]) is_chosen[vertex] = true;
    Places places(distance);
    std::vector<std::uint32_t> of_place, moved(mesh.vertices.size(), none);
    TriangleMesh merged;
    const auto add = [&](std::uint32_t vertex) {
        merged.vertices.push_back(mesh.vertices[vertex]);
        return static_cast<std::uint32_t>(merged.vertices.size() - 1);
    };
    for (Triple& triangle : mesh.triangles)
        for (std::uint32_t& vertex : triangle) {
            std::uint32_t& number = moved[vertex];
            if (number == none && is_chosen[vertex]) {
                const std::uint32_t place = places.find_or_add(mesh.vertices[vertex]);
                if (place == of_place.size()) of_place.push_back(add(vertex));
                number = of_place[place];
            } else if (number == none) {
                number = add(vertex);
            }
            vertex = number;
        }
    mesh.vertices = std::move(merged.vertices);
}

Contacts find_contacts(TriangleMesh& mesh, double tolerance, const std::vector<bool>& chosen)
{
    return ContactFinder(mesh, tolerance, chosen).find();
}

} // namespace tetrace
