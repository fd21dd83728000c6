#include "scenes/builder/polygon.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

// Sources: Chew, "Constrained Delaunay Triangulations", 1989 (by CGAL); Meisters, "Polygons have ears", 1975.

namespace tetrace {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Triangles = std::vector<std::array<std::size_t, 3>>;

// A polygon in the plane on which it is largest, counterclockwise there.
class FlatPolygon {
public:
    explicit FlatPolygon(std::span<const Float3> corners) : corners_(corners)
    {
        Double3 normal{0, 0, 0}; // Newell's, of length twice the area
        const Double3 first = to_double(corners[0]);
        for (std::size_t i = 2; i < corners.size(); ++i)
            normal = normal + cross(to_double(corners[i - 1]) - first, to_double(corners[i]) - first);
        const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
        for (const Float3 corner : corners) {
            const Double3 v = to_double(corner);
            if (x >= y && x >= z)
                points_.emplace_back(normal.x < 0 ? -v.y : v.y, v.z);
            else if (y >= z)
                points_.emplace_back(normal.y < 0 ? -v.z : v.z, v.x);
            else
                points_.emplace_back(normal.z < 0 ? -v.x : v.x, v.y);
        }
        area_ = std::max({x, y, z});
    }

    [[nodiscard]] std::size_t size() const { return points_.size(); }
    [[nodiscard]] const Point& operator[](std::size_t corner) const { return points_[corner]; }
    // Twice its area, and that of a triangle of corners; the latter is negative if it is clockwise.
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] double area(std::size_t a, std::size_t b, std::size_t c) const
    {
        const Point &p = points_[a], &q = points_[b], &r = points_[c];
        return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    }
    // Exact.
    [[nodiscard]] int turn(std::size_t a, std::size_t b, std::size_t c) const
    {
        return CGAL::orientation(points_[a], points_[b], points_[c]);
    }
    [[nodiscard]] bool holds(std::size_t a, std::size_t b, std::size_t c, std::size_t other) const
    {
        return turn(a, b, other) >= 0 && turn(b, c, other) >= 0 && turn(c, a, other) >= 0;
    }
    [[nodiscard]] bool same_place(std::size_t a, std::size_t b) const { return points_[a] == points_[b]; }
    // Exact, and in space.
    [[nodiscard]] bool is_on_line() const
    {
        const auto point = [&](std::size_t corner) {
            const Double3 v = to_double(corners_[corner]);
            return Kernel::Point_3(v.x, v.y, v.z);
        };
        std::size_t second = 1;
        while (second < size() && same_vertex(0, second))
            ++second;
        for (std::size_t i = second + 1; i < size(); ++i)
            if (!CGAL::collinear(point(0), point(second), point(i))) return false;
        return true;
    }
    // The same place in space, not only in the projection.
    [[nodiscard]] bool same_vertex(std::size_t a, std::size_t b) const { return corners_[a] == corners_[b]; }

private:
    std::span<const Float3> corners_;
    std::vector<Point> points_;
    double area_ = 0;
};

Triangles fan(std::size_t corners)
{
    Triangles triangles;
    for (std::size_t i = 2; i < corners; ++i)
        triangles.push_back({0, i - 1, i});
    return triangles;
}

// Triangles of one orientation around a corner, in less than a full rotation, do not overlap.
bool is_fan_sound(const FlatPolygon& polygon)
{
    for (std::size_t i = 2; i < polygon.size(); ++i)
        if (polygon.turn(0, i - 1, i) <= 0) return false;
    return true;
}

struct FaceState {
    std::optional<int> winding; // how often the polygon goes around it, counterclockwise
    bool is_cell_done = false;
};

class Triangulation {
    using Vertices = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
    using Faces = CGAL::Triangulation_face_base_with_info_2<FaceState, Kernel,
                                                            CGAL::Constrained_triangulation_face_base_2<Kernel>>;
    using Delaunay =
        CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertices, Faces>,
                                                   CGAL::No_constraint_intersection_requiring_constructions_tag>;
    using Vertex = Delaunay::Vertex_handle;
    using Face = Delaunay::Face_handle;

public:
    explicit Triangulation(const FlatPolygon& polygon) : polygon_(polygon) {}

    // Nothing if the polygon crosses itself, or has no inside.
    std::optional<Triangles> cut()
    {
        if (!insert_corners() || delaunay_.dimension() < 2 || !insert_edges()) return std::nullopt;
        count_windings();
        int inside = 0;
        for (const Face face : delaunay_.finite_face_handles()) {
            const int winding = *face->info().winding;
            if (winding != 0 && inside != 0 && winding != inside) return std::nullopt;
            if (winding != 0) inside = winding;
        }
        if (std::abs(inside) != 1) return std::nullopt;
        Triangles triangles;
        for (const Face face : delaunay_.finite_face_handles())
            if (*face->info().winding != 0 && !face->info().is_cell_done) add_cell(face, inside < 0, triangles);
        std::sort(triangles.begin(), triangles.end()); // CGAL's versions may have faces in another order
        return triangles;
    }

private:
    bool insert_corners()
    {
        Face hint{};
        for (std::size_t i = 0; i < polygon_.size(); ++i) {
            const std::size_t before = delaunay_.number_of_vertices();
            const Vertex vertex = delaunay_.insert(polygon_[i], hint);
            if (delaunay_.number_of_vertices() > before)
                vertex->info() = i;
            else if (!polygon_.same_vertex(vertex->info(), i))
                return false;
            hint = vertex->face();
            vertices_.push_back(vertex);
        }
        return true;
    }
    bool insert_edges()
    {
        try {
            each_edge([&](Vertex a, Vertex b) { delaunay_.insert_constraint(a, b); });
        } catch (const Delaunay::Intersection_of_constraints_exception&) {
            return false;
        }
        each_edge([&](Vertex a, Vertex b) { count_traversals(a, b); });
        return true;
    }
    template <class Work>
    void each_edge(const Work& work) const
    {
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            if (const Vertex a = vertices_[i], b = vertices_[(i + 1) % vertices_.size()]; a != b) work(a, b);
    }
    // An edge through other vertices is several edges of the triangulation.
    void count_traversals(Vertex a, const Vertex& end)
    {
        while (a != end) {
            const Vertex b = delaunay_.is_edge(a, end) ? end : next_towards(a, end);
            const std::size_t from = a->info(), to = b->info();
            traversals_[std::minmax(from, to)] += from < to ? 1 : -1;
            a = b;
        }
    }
    Vertex next_towards(const Vertex& a, const Vertex& end) const
    {
        auto around = delaunay_.incident_vertices(a);
        const auto is_on_the_way = [&](const Vertex& v) {
            return !delaunay_.is_infinite(v) && CGAL::are_ordered_along_line(a->point(), v->point(), end->point());
        };
        while (!is_on_the_way(around))
            ++around;
        return around;
    }

    void count_windings()
    {
        std::vector<Face> open{delaunay_.infinite_face()};
        open.back()->info().winding = 0;
        while (!open.empty()) {
            const Face face = open.back();
            open.pop_back();
            for (int i = 0; i < 3; ++i) {
                const Face other = face->neighbor(i);
                if (other->info().winding) continue;
                other->info().winding = *face->info().winding - traversals_to_left(face, i);
                open.push_back(other);
            }
        }
    }
    // How often the polygon has the face on its left along the edge that the face shares with its neighbour i.
    [[nodiscard]] int traversals_to_left(const Face& face, int i) const
    {
        if (!face->is_constrained(i)) return 0;
        const std::size_t from = face->vertex(Delaunay::ccw(i))->info(), to = face->vertex(Delaunay::cw(i))->info();
        const auto found = traversals_.find(std::minmax(from, to));
        return found == traversals_.end() ? 0 : from < to ? found->second : -found->second;
    }

    // The faces of one circle that no edge of the polygon separates are one convex cell, whichever way CGAL cut it.
    void add_cell(const Face& first, bool is_clockwise, Triangles& triangles)
    {
        std::map<std::size_t, std::size_t> next; // corners along its boundary
        std::vector<Face> open{first};
        first->info().is_cell_done = true;
        while (!open.empty()) {
            const Face face = open.back();
            open.pop_back();
            for (int i = 0; i < 3; ++i) {
                const Face other = face->neighbor(i);
                if (is_in_cell(face, i)) {
                    if (!std::exchange(other->info().is_cell_done, true)) open.push_back(other);
                } else {
                    next[face->vertex(Delaunay::ccw(i))->info()] = face->vertex(Delaunay::cw(i))->info();
                }
            }
        }
        const std::size_t tip = next.begin()->first;
        for (std::size_t a = next.at(tip), b = next.at(a); b != tip; a = std::exchange(b, next.at(b)))
            triangles.push_back(is_clockwise ? std::array{tip, b, a} : std::array{tip, a, b});
    }
    [[nodiscard]] bool is_in_cell(const Face& face, int i) const
    {
        const Face other = face->neighbor(i);
        return !face->is_constrained(i) && !delaunay_.is_infinite(other) &&
               CGAL::side_of_oriented_circle(face->vertex(0)->point(), face->vertex(1)->point(),
                                             face->vertex(2)->point(),
                                             other->vertex(other->index(face))->point()) == CGAL::ON_ORIENTED_BOUNDARY;
    }

    const FlatPolygon& polygon_;
    Delaunay delaunay_;
    std::vector<Vertex> vertices_;                                  // of each corner
    std::map<std::pair<std::size_t, std::size_t>, int> traversals_; // of edges, upwards minus downwards
};

class EarCutter {
public:
    explicit EarCutter(const FlatPolygon& polygon) : polygon_(polygon)
    {
        for (std::size_t i = 0; i < polygon.size(); ++i)
            left_.push_back(i);
    }

    Triangles cut()
    {
        std::size_t at = 0, misses = 0;
        while (left_.size() > 3) {
            at %= left_.size();
            // If no corner is an ear, any is taken.
            if (misses++ < left_.size() && !is_ear(at)) {
                ++at;
                continue;
            }
            triangles_.push_back(ear(at));
            left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
            misses = 0;
        }
        triangles_.push_back({left_[0], left_[1], left_[2]});
        return std::move(triangles_);
    }

private:
    [[nodiscard]] std::array<std::size_t, 3> ear(std::size_t at) const
    {
        const std::size_t count = left_.size();
        return {left_[(at + count - 1) % count], left_[at], left_[(at + 1) % count]};
    }
    [[nodiscard]] bool is_ear(std::size_t at) const
    {
        const auto [a, b, c] = ear(at);
        if (polygon_.turn(a, b, c) <= 0) return false;
        for (const std::size_t other : left_) {
            const bool is_corner =
                polygon_.same_place(other, a) || polygon_.same_place(other, b) || polygon_.same_place(other, c);
            if (!is_corner && polygon_.holds(a, b, c, other)) return false;
        }
        return true;
    }

    const FlatPolygon& polygon_;
    std::vector<std::size_t> left_;
    Triangles triangles_;
};

// Of a polygon that has an inside only once. Without an area, it has none, and its projection may be on a line.
bool areas_add_up(const FlatPolygon& polygon, const Triangles& triangles)
{
    if (polygon.area() == 0) return polygon.is_on_line();
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += std::abs(polygon.area(a, b, c));
    return std::abs(sum - polygon.area()) <= 1e-6 * sum;
}

} // namespace

CutPolygon cut_polygon(std::span<const Float3> corners)
{
    const FlatPolygon polygon(corners);
    if (is_fan_sound(polygon)) return {fan(corners.size()), true};
    CutPolygon cut;
    if (auto triangles = Triangulation(polygon).cut())
        cut.triangles = std::move(*triangles);
    else
        cut.triangles = corners.size() > max_crossing_corners ? fan(corners.size()) : EarCutter(polygon).cut();
    cut.is_simple = areas_add_up(polygon, cut.triangles);
    return cut;
}

} // namespace tetrace
