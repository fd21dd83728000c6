#include "scenes/builder/repair/arrangement.h"

#include "core/base/exact.h"
#include "scenes/builder/repair/contacts.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <variant>

namespace tetrace {
namespace {

// Each number has an interval and computes exactly only what that cannot decide. What a triangle needs is made by the
// thread that cuts it.
using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = ExactKernel::FT;
using ExactPoint = ExactKernel::Point_3;
using ExactPlane = ExactKernel::Plane_3;
using ExactLine = ExactKernel::Line_3;
using Line2 = ExactKernel::Line_2;

// CGAL looks up a vertex by its point, and intervals cannot say that a point is equal to itself.
struct FlatTraits : ExactKernel {
    struct Compare_x_2 {
        CGAL::Comparison_result operator()(const Point_2& p, const Point_2& q) const
        {
            return identical(p, q) ? CGAL::EQUAL : ExactKernel().compare_x_2_object()(p, q);
        }
    };
    struct Compare_y_2 {
        CGAL::Comparison_result operator()(const Point_2& p, const Point_2& q) const
        {
            return identical(p, q) ? CGAL::EQUAL : ExactKernel().compare_y_2_object()(p, q);
        }
    };
    [[nodiscard]] static Compare_x_2 compare_x_2_object() { return {}; }
    [[nodiscard]] static Compare_y_2 compare_y_2_object() { return {}; }
};
using Delaunay = CGAL::Constrained_triangulation_plus_2<
    CGAL::Constrained_Delaunay_triangulation_2<FlatTraits, CGAL::Default, CGAL::Exact_intersections_tag>>;
using FlatPoint = Delaunay::Point;

// std's from CGAL 6 on, boost's before.
template <class Shape, class Variant>
const Shape& held_shape(const Variant& variant)
{
    if constexpr (requires { std::get<Shape>(variant); })
        return std::get<Shape>(variant);
    else
        return *get<Shape>(&variant);
}

float rounded(double number)
{
    return snap_to_grid(static_cast<float>(number));
}

// Of the exact value, which is computed only if the ends of the number's interval are rounded apart.
float rounded(const Number& number)
{
    const auto [low, high] = CGAL::to_interval(number);
    return rounded(low) == rounded(high) ? rounded(low) : rounded(CGAL::to_double(number.exact()));
}

// Of floats.
using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triple = std::array<std::uint32_t, 3>;

int volume_sign(Float3 a, Float3 b, Float3 c, Float3 d)
{
    const auto point = [](Float3 p) {
        const Double3 v = to_double(p);
        return Predicates::Point_3(v.x, v.y, v.z);
    };
    return CGAL::orientation(point(a), point(b), point(c), point(d));
}

// Points in a triangle's plane, seen along an axis.
class Flattened {
public:
    Flattened(const TriangleMesh& mesh, const Triple& triangle) : mesh_(mesh)
    {
        while (along_ < 2 && turn(triangle[0], triangle[1], triangle[2]) == 0)
            ++along_;
    }
    [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const
    {
        return CGAL::orientation(flat(a), flat(b), flat(c));
    }
    // Sides included.
    [[nodiscard]] bool has(const Triple& triangle, std::uint32_t vertex) const
    {
        std::array<int, 3> turns{};
        for (std::size_t i = 0; i < 3; ++i)
            turns[i] = turn(triangle[i], triangle[(i + 1) % 3], vertex);
        const auto [least, most] = std::ranges::minmax(turns);
        return least * most >= 0;
    }
    // Whether it is on the segment, not at its ends.
    [[nodiscard]] bool is_between(std::uint32_t from, std::uint32_t to, std::uint32_t vertex) const
    {
        return vertex != from && vertex != to && turn(from, to, vertex) == 0 &&
               CGAL::collinear_are_strictly_ordered_along_line(flat(from), flat(vertex), flat(to));
    }

private:
    [[nodiscard]] Predicates::Point_2 flat(std::uint32_t vertex) const
    {
        const Float3 v = mesh_.vertices[vertex];
        return {v[(along_ + 1) % 3], v[(along_ + 2) % 3]};
    }

    const TriangleMesh& mesh_;
    int along_ = 0;
};

// What a point of two triangles is, so that it is made once: a vertex; an edge and a triangle that it crosses; or two
// edges. Each in a fixed order.
using Key = std::array<std::optional<std::uint32_t>, 4>;

Key key_of(const Edge& e, const Edge& f)
{
    const auto& [first, second] = std::minmax(e, f);
    return {first.first, first.second, second.first, second.second};
}

// Where an edge meets a triangle's plane, or another edge in its own plane; neither: at a vertex.
struct Meeting {
    Key key;
    Edge edge = {};
    std::optional<std::uint32_t> triangle = {};
    std::optional<Edge> other = {};
};

// A triangle's plane, seen along the axis that its normal leans to most.
class Plane {
public:
    explicit Plane(ExactPlane plane) : plane_(std::move(plane))
    {
        const auto size = [&](int axis) { return CGAL::abs(normal(axis)); };
        for (int axis = 1; axis < 3; ++axis)
            if (size(axis) > size(along_)) along_ = axis;
    }

    [[nodiscard]] const ExactPlane& plane() const { return plane_; }
    [[nodiscard]] FlatPoint flat(const ExactPoint& point) const { return {point[across(1)], point[across(2)]}; }
    // The point of the plane there.
    [[nodiscard]] Float3 lifted(const FlatPoint& at) const
    {
        const Number height = -(normal(across(1)) * at.x() + normal(across(2)) * at.y() + plane_.d()) / normal(along_);
        Float3 point;
        point[along_] = rounded(height);
        point[across(1)] = rounded(at.x());
        point[across(2)] = rounded(at.y());
        return point;
    }
    // Whether the triangle's own order of corners is clockwise there.
    [[nodiscard]] bool is_turned() const { return normal(along_) < 0; }

private:
    [[nodiscard]] int across(int step) const { return (along_ + step) % 3; }
    [[nodiscard]] Number normal(int axis) const { return axis == 0 ? plane_.a() : axis == 1 ? plane_.b() : plane_.c(); }

    ExactPlane plane_;
    int along_ = 0;
};

using Piece = std::array<Float3, 3>;

// A triangle, and the lines along which it is cut.
class CutTriangle {
public:
    CutTriangle(const TriangleMesh& mesh, std::uint32_t triangle)
        : mesh_(mesh), number_(triangle), plane_(plane(triangle))
    {
        for (const std::uint32_t corner : mesh.triangles[triangle])
            static_cast<void>(vertex({.key = {corner}}));
    }

    void cut_by(std::uint32_t other)
    {
        const Triple &own = mesh_.triangles[number_], &its = mesh_.triangles[other];
        std::vector<Meeting> all;
        const bool flat = is_above(own, its[0]) == 0 && is_above(own, its[1]) == 0 && is_above(own, its[2]) == 0;
        for (std::size_t i = 0; i < 3; ++i) {
            add_meetings(side_of(its, i), number_, all);
            if (flat) { // what it overlaps ends on its sides, and on this one's
                join(all);
                all.clear();
            } else {
                add_meetings(side_of(own, i), other, all);
            }
        }
        join(all);
    }
    [[nodiscard]] std::vector<Piece> pieces() const
    {
        std::unordered_map<const void*, Float3> lifted;
        for (const auto vertex : delaunay_.finite_vertex_handles())
            lifted.emplace(&*vertex, plane_.lifted(vertex->point()));
        std::vector<Piece> pieces;
        for (const auto face : delaunay_.finite_face_handles()) {
            const auto corner = [&](int i) { return lifted.at(&*face->vertex(i)); };
            const bool turned = plane_.is_turned();
            pieces.push_back({corner(0), corner(turned ? 2 : 1), corner(turned ? 1 : 2)});
        }
        return pieces;
    }

private:
    [[nodiscard]] ExactPoint exact(std::uint32_t vertex) const
    {
        const Double3 v = to_double(mesh_.vertices[vertex]);
        return {v.x, v.y, v.z};
    }
    [[nodiscard]] ExactPlane plane(std::uint32_t triangle) const
    {
        const auto& [a, b, c] = mesh_.triangles[triangle];
        return {exact(a), exact(b), exact(c)};
    }
    [[nodiscard]] int is_above(const Triple& triangle, std::uint32_t vertex) const
    {
        const auto at = [&](std::uint32_t i) { return mesh_.vertices[i]; };
        return volume_sign(at(triangle[0]), at(triangle[1]), at(triangle[2]), at(vertex));
    }

    // Where an edge meets a triangle: nothing, a point, or the two ends of what they share.
    void add_meetings(const Edge& edge, std::uint32_t triangle, std::vector<Meeting>& all) const
    {
        const Triple& corners = mesh_.triangles[triangle];
        const auto [p, q] = edge;
        const int above = is_above(corners, p), below = is_above(corners, q);
        if (above * below > 0) return;
        if (above * below == 0) {
            const Flattened flat(mesh_, corners);
            if (above == 0 && flat.has(corners, p)) all.push_back({.key = {p}});
            if (below == 0 && flat.has(corners, q)) all.push_back({.key = {q}});
            if (above == 0 && below == 0) add_flat_meetings(flat, edge, triangle, all);
            return;
        }
        std::array<int, 3> beside{};
        for (std::size_t i = 0; i < 3; ++i)
            beside[i] = volume_sign(mesh_.vertices[p], mesh_.vertices[q], mesh_.vertices[corners[i]],
                                    mesh_.vertices[corners[(i + 1) % 3]]);
        const auto [least, most] = std::ranges::minmax(beside);
        if (least * most < 0) return;
        std::vector<std::size_t> through;
        for (std::size_t i = 0; i < 3; ++i)
            if (beside[i] == 0) through.push_back(i);
        if (through.empty()) return all.push_back({{p, q, triangle}, edge, triangle});
        if (through.size() == 1) return all.push_back({key_of(edge, side_of(corners, through[0])), edge, triangle});
        // Two sides meet in the corner that the third lacks.
        all.push_back({.key = {corners[through[0] == 0 && through[1] == 2 ? 0 : through[1]]}});
    }
    // Of an edge in a triangle's plane: where it crosses the sides, and the corners on it.
    void add_flat_meetings(const Flattened& flat, const Edge& edge, std::uint32_t triangle,
                           std::vector<Meeting>& all) const
    {
        const Triple& corners = mesh_.triangles[triangle];
        const auto [p, q] = edge;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] = side_of(corners, i);
            if (flat.turn(a, b, p) * flat.turn(a, b, q) < 0 && flat.turn(p, q, a) * flat.turn(p, q, b) < 0)
                all.push_back(triangle == number_ ? Meeting{key_of(edge, {a, b}), edge, std::nullopt, Edge{a, b}}
                                                  : Meeting{key_of(edge, {a, b}), {a, b}, number_});
            if (flat.is_between(p, q, corners[i])) all.push_back({.key = {corners[i]}});
        }
    }

    [[nodiscard]] FlatPoint point(const Meeting& meeting) const
    {
        const auto [p, q] = meeting.edge;
        if (meeting.other) {
            const auto& [a, b] = *meeting.other;
            const auto met = CGAL::intersection(Line2(plane_.flat(exact(p)), plane_.flat(exact(q))),
                                                Line2(plane_.flat(exact(a)), plane_.flat(exact(b))));
            return held_shape<FlatPoint>(*met);
        }
        if (!meeting.triangle) return plane_.flat(exact(*meeting.key[0]));
        const ExactLine line(exact(p), exact(q));
        const auto met = *meeting.triangle == number_ ? CGAL::intersection(line, plane_.plane())
                                                      : CGAL::intersection(line, plane(*meeting.triangle));
        return plane_.flat(held_shape<ExactPoint>(*met));
    }
    Delaunay::Vertex_handle vertex(const Meeting& meeting)
    {
        const auto [known, is_new] = vertices_.try_emplace(meeting.key);
        if (is_new) known->second = delaunay_.insert(point(meeting));
        return known->second;
    }
    // Makes an edge of the ends.
    void join(const std::vector<Meeting>& ends)
    {
        std::vector<Delaunay::Vertex_handle> handles;
        for (const Meeting& end : ends) {
            const auto handle = vertex(end);
            if (std::ranges::find(handles, handle) == handles.end()) handles.push_back(handle);
        }
        for (std::size_t i = 1; i < handles.size(); ++i)
            delaunay_.insert_constraint(handles[i - 1], handles[i]);
    }

    const TriangleMesh& mesh_;
    std::uint32_t number_;
    Plane plane_;
    Delaunay delaunay_;
    std::map<Key, Delaunay::Vertex_handle> vertices_;
};

std::vector<Piece> cut(const TriangleMesh& mesh, std::uint32_t triangle, std::span<const std::uint32_t> others)
{
    CutTriangle pieces(mesh, triangle);
    for (const std::uint32_t other : others)
        pieces.cut_by(other);
    return pieces.pieces();
}

} // namespace

CutMesh cut_along_intersections(const TriangleMesh& mesh, std::span<const TrianglePair> pairs)
{
    std::vector<std::vector<std::uint32_t>> others(mesh.triangles.size());
    for (const auto& [first, second] : pairs) {
        others[first].push_back(second);
        others[second].push_back(first);
    }
    std::vector<std::vector<Piece>> pieces(others.size());
    std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 4)
    for (std::uint32_t i = 0; i < others.size(); ++i) {
        try {
            if (!others[i].empty()) pieces[i] = cut(mesh, i, others[i]);
        } catch (...) {
#pragma omp critical
            failure = std::current_exception();
        }
    }
    if (failure) std::rethrow_exception(failure);
    CutMesh result;
    result.mesh.vertices = mesh.vertices;
    for (std::uint32_t i = 0; i < others.size(); ++i) {
        if (others[i].empty()) {
            result.mesh.triangles.push_back(mesh.triangles[i]);
            result.parents.push_back(i);
        }
        for (const Piece& piece : pieces[i]) {
            const auto first = static_cast<std::uint32_t>(result.mesh.vertices.size());
            result.mesh.vertices.insert(result.mesh.vertices.end(), piece.begin(), piece.end());
            result.mesh.triangles.push_back({first, first + 1, first + 2});
            result.parents.push_back(i);
        }
    }
    return result;
}

} // namespace tetrace
