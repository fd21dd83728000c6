#include "scenes/builder/repair/weld.h"

#include "core/base/exact.h"
#include "scenes/builder/triple_hash.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

// The idea is that of snap rounding (Hobby, "Practical segment intersection with finite precision output", 1999):
// what passes near a vertex passes through it.

namespace tetrace {
namespace {

using Triple = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>; // the lower vertex first

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

Edge edge_of(std::uint32_t a, std::uint32_t b)
{
    return std::minmax(a, b);
}

Edge edge_of(const Triple& triangle, std::size_t i)
{
    return edge_of(triangle[i], triangle[(i + 1) % 3]);
}

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
        cells_[cell_of(point, {0, 0, 0})].push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(point);
        return static_cast<std::uint32_t>(points.size() - 1);
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

// Where edges and triangles are to be cut. New vertices are added to the mesh.
struct Contacts {
    std::map<Edge, std::vector<std::uint32_t>> on_edges;
    std::vector<std::vector<std::uint32_t>> in_triangles, others; // of each triangle: vertices; triangles near it
};

class ContactFinder {
public:
    ContactFinder(const TriangleMesh& mesh, Places& places, double tolerance)
        : mesh_(mesh), places_(places), tolerance_(tolerance)
    {
        contacts_.in_triangles.resize(mesh.triangles.size());
        contacts_.others.resize(mesh.triangles.size());
    }

    Contacts find()
    {
        const std::vector<Edge> pairs = near_pairs();
        for (const auto& [a, b] : pairs) {
            contacts_.others[a].push_back(b);
            contacts_.others[b].push_back(a);
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    meet(edge_of(mesh_.triangles[a], i), edge_of(mesh_.triangles[b], k));
            pierce(a, b);
            pierce(b, a);
        }
        attach_vertices();
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
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
            boxes.emplace_back(grown_box(i, 0.51), i);
        std::vector<Edge> pairs;
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const GrownBox& a, const GrownBox& b) {
            pairs.push_back(edge_of(a.info(), b.info()));
        });
        std::ranges::sort(pairs);
        return pairs;
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
            triangles.emplace_back(grown_box(i, 1.01), i);
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
            if (is_near(vertex, edge_of(triangle, i))) {
                add_to(edge_of(triangle, i), vertex);
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
            const Edge edge = edge_of(mesh_.triangles[from], i);
            const Double3 p = at(edge.first), q = at(edge.second);
            const double above = seen_from(triangle, p).height, below = seen_from(triangle, q).height;
            if (above * below >= 0) continue;
            const Double3 point = p + (q - p) * (above / (above - below));
            if (seen_from(triangle, point).inside > 0) add_vertex(point);
        }
    }

    const TriangleMesh& mesh_;
    Places& places_;
    double tolerance_;
    Contacts contacts_;
    std::set<std::pair<Edge, Edge>> met_;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Flat = Kernel::Point_2;
using Overlay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>,
                                         CGAL::Constrained_triangulation_face_base_2<Kernel>>,
    CGAL::Exact_predicates_tag>;

// Cuts triangles at their contacts.
class Cutter {
public:
    Cutter(TriangleMesh& mesh, Contacts contacts) : mesh_(mesh), contacts_(std::move(contacts))
    {
        for (auto& [edge, list] : contacts_.on_edges) {
            const Double3 from = to_double(mesh.vertices[edge.first]),
                          along = to_double(mesh.vertices[edge.second]) - from;
            std::ranges::stable_sort(
                list, {}, [&](std::uint32_t vertex) { return dot(to_double(mesh_.vertices[vertex]) - from, along); });
        }
    }

    void cut(std::vector<std::uint32_t>& origins)
    {
        const std::vector<Triple> triangles = std::move(mesh_.triangles);
        mesh_.triangles.clear();
        std::vector<std::uint32_t> of_pieces;
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            cut(triangles, i);
            of_pieces.resize(mesh_.triangles.size(), origins[i]);
        }
        origins = std::move(of_pieces);
    }

private:
    // The vertices along an edge, ends included, from `from` on.
    [[nodiscard]] std::vector<std::uint32_t> line(std::uint32_t from, std::uint32_t to) const
    {
        std::vector<std::uint32_t> all{std::min(from, to)};
        if (const auto found = contacts_.on_edges.find(edge_of(from, to)); found != contacts_.on_edges.end())
            all.insert(all.end(), found->second.begin(), found->second.end());
        all.push_back(std::max(from, to));
        if (from > to) std::ranges::reverse(all);
        return all;
    }
    [[nodiscard]] std::vector<std::uint32_t> outline(const Triple& triangle) const
    {
        std::vector<std::uint32_t> all;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto side = line(triangle[i], triangle[(i + 1) % 3]);
            all.insert(all.end(), side.begin(), side.end() - 1);
        }
        return all;
    }

    void cut(const std::vector<Triple>& triangles, std::uint32_t number)
    {
        const Triple& triangle = triangles[number];
        const std::vector<std::uint32_t> sides = outline(triangle);
        const std::vector<std::uint32_t>& inner = contacts_.in_triangles[number];
        if (sides.size() == 3 && inner.empty()) {
            mesh_.triangles.push_back(triangle);
            return;
        }
        const Double3 a = to_double(mesh_.vertices[triangle[0]]);
        const Double3 normal =
            cross(to_double(mesh_.vertices[triangle[1]]) - a, to_double(mesh_.vertices[triangle[2]]) - a);
        int along = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (std::abs(part(normal, axis)) > std::abs(part(normal, along))) along = axis;
        const auto flat = [&](std::uint32_t vertex) {
            const Double3 p = to_double(mesh_.vertices[vertex]);
            return Flat(part(p, (along + 1) % 3), part(p, (along + 2) % 3));
        };
        std::vector<Flat> polygon;
        for (const std::uint32_t vertex : sides)
            polygon.push_back(flat(vertex));
        Overlay delaunay;
        std::map<std::uint32_t, Overlay::Vertex_handle> handles;
        const auto insert = [&](std::uint32_t vertex) {
            if (handles.contains(vertex)) return;
            const std::size_t before = delaunay.number_of_vertices();
            const auto handle = delaunay.insert(flat(vertex));
            if (delaunay.number_of_vertices() == before) return; // over another, which is not near in space
            handle->info() = vertex;
            handles.emplace(vertex, handle);
        };
        for (const std::uint32_t vertex : sides)
            insert(vertex);
        for (const std::uint32_t vertex : inner)
            if (is_inside(polygon, flat(vertex))) insert(vertex);
        const auto join = [&](std::uint32_t p, std::uint32_t q) {
            const auto from = handles.find(p), to = handles.find(q);
            if (from != handles.end() && to != handles.end() && from->second != to->second)
                delaunay.insert_constraint(from->second, to->second);
        };
        for (std::size_t i = 0; i < sides.size(); ++i)
            join(sides[i], sides[(i + 1) % sides.size()]);
        for (const std::uint32_t other : contacts_.others[number]) {
            std::vector<std::uint32_t> shared;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto list = line(triangles[other][i], triangles[other][(i + 1) % 3]);
                for (std::size_t k = 0; k + 1 < list.size(); ++k) {
                    join(list[k], list[k + 1]);
                    if (handles.contains(list[k])) shared.push_back(list[k]);
                }
            }
            for (const std::uint32_t vertex : contacts_.in_triangles[other])
                if (handles.contains(vertex)) shared.push_back(vertex);
            if (shared.size() == 2) join(shared[0], shared[1]);
        }
        std::map<const void*, std::uint32_t> made; // where constraints cross
        const auto vertex_of = [&](Overlay::Vertex_handle handle) {
            if (const auto found = handles.find(handle->info()); found != handles.end() && found->second == handle)
                return handle->info();
            const auto [place, is_new] = made.try_emplace(&*handle, static_cast<std::uint32_t>(mesh_.vertices.size()));
            if (is_new) mesh_.vertices.push_back(lifted(handle->point(), a, normal, along));
            return place->second;
        };
        for (const auto face : delaunay.finite_face_handles()) {
            const Flat middle = CGAL::centroid(delaunay.triangle(face));
            if (!is_inside(polygon, middle)) continue;
            const bool turned = part(normal, along) < 0;
            mesh_.triangles.push_back({vertex_of(face->vertex(0)), vertex_of(face->vertex(turned ? 2 : 1)),
                                       vertex_of(face->vertex(turned ? 1 : 2))});
        }
    }

    static double part(Double3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
    static Float3 lifted(const Flat& point, Double3 on_plane, Double3 normal, int along)
    {
        Float3 result;
        const int u = (along + 1) % 3, v = (along + 2) % 3;
        const double height = part(on_plane, along) - (part(normal, u) * (point.x() - part(on_plane, u)) +
                                                       part(normal, v) * (point.y() - part(on_plane, v))) /
                                                          part(normal, along);
        result[along] = static_cast<float>(height);
        result[u] = static_cast<float>(point.x());
        result[v] = static_cast<float>(point.y());
        return snap_to_grid(result);
    }
    static bool is_inside(const std::vector<Flat>& polygon, const Flat& point)
    {
        bool inside = false;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            Flat low = polygon[i], high = polygon[(i + 1) % polygon.size()];
            if (low.y() > high.y()) std::swap(low, high);
            if (low.y() <= point.y() && point.y() < high.y() && CGAL::left_turn(low, high, point)) inside = !inside;
        }
        return inside;
    }

    TriangleMesh& mesh_;
    Contacts contacts_;
};

} // namespace

void weld(TriangleMesh& mesh, std::vector<std::uint32_t>& origins, double tolerance)
{
    Places places(tolerance / 2);
    for (Triple& triangle : mesh.triangles)
        for (std::uint32_t& vertex : triangle)
            vertex = places.find_or_add(mesh.vertices[vertex]);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        if (a == b || b == c || c == a) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        origins[kept++] = origins[i];
    }
    mesh.triangles.resize(kept);
    origins.resize(kept);
    Contacts contacts = ContactFinder(mesh, places, tolerance).find();
    mesh.vertices = std::move(places.points);
    Cutter(mesh, std::move(contacts)).cut(origins);
}

} // namespace tetrace
