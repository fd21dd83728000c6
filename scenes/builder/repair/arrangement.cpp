#include "scenes/builder/repair/arrangement.h"

#include "core/base/exact.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <array>
#include <exception>
#include <unordered_map>
#include <variant>

namespace tetrace {
namespace {

// Each number has an interval and computes exactly only what that cannot decide. What a triangle needs is made by the
// thread that cuts it.
using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = ExactKernel::FT;
using ExactPoint = ExactKernel::Point_3;
using Segment = ExactKernel::Segment_3;
using Triangle = ExactKernel::Triangle_3;
using Corners = std::array<ExactPoint, 3>;
using Delaunay = CGAL::Constrained_triangulation_plus_2<
    CGAL::Constrained_Delaunay_triangulation_2<ExactKernel, CGAL::Default, CGAL::Exact_intersections_tag>>;
using FlatPoint = Delaunay::Point;

// std's from CGAL 6 on, boost's before.
template <class Shape, class Variant>
const Shape* held_shape(const Variant& variant)
{
    if constexpr (requires { std::get_if<Shape>(&variant); })
        return std::get_if<Shape>(&variant);
    else
        return get<Shape>(&variant);
}

// The corners of what two triangles share, in order: one of a point, two of a segment, else those of a polygon.
std::vector<ExactPoint> shared_corners(const Corners& a, const Corners& b)
{
    const auto shared = CGAL::intersection(Triangle(a[0], a[1], a[2]), Triangle(b[0], b[1], b[2]));
    if (!shared) return {};
    if (const auto* point = held_shape<ExactPoint>(*shared)) return {*point};
    if (const auto* segment = held_shape<Segment>(*shared)) return {segment->source(), segment->target()};
    if (const auto* triangle = held_shape<Triangle>(*shared))
        return {triangle->vertex(0), triangle->vertex(1), triangle->vertex(2)};
    return *held_shape<std::vector<ExactPoint>>(*shared);
}

float rounded(double number)
{
    return snap_to_grid(static_cast<float>(number));
}

// Of the exact value, which is computed only where the ends of the number's interval are rounded apart.
float rounded(const Number& number)
{
    const auto [low, high] = CGAL::to_interval(number);
    return rounded(low) == rounded(high) ? rounded(low) : rounded(CGAL::to_double(number.exact()));
}

// A triangle's plane, seen along the axis that its normal leans to most.
class Plane {
public:
    explicit Plane(const Corners& corners) : plane_(corners[0], corners[1], corners[2])
    {
        const auto size = [&](int axis) { return CGAL::abs(normal(axis)); };
        for (int axis = 1; axis < 3; ++axis)
            if (size(axis) > size(along_)) along_ = axis;
    }

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

    ExactKernel::Plane_3 plane_;
    int along_ = 0;
};

using Piece = std::array<Float3, 3>;

// A triangle, and the lines along which it is cut.
class CutTriangle {
public:
    explicit CutTriangle(const Corners& corners) : plane_(corners) { add({corners.begin(), corners.end()}); }

    // Corners as of shared_corners().
    void add(const std::vector<ExactPoint>& corners)
    {
        std::vector<FlatPoint> flat;
        for (const ExactPoint& corner : corners)
            flat.push_back(plane_.flat(corner));
        if (flat.size() == 1) delaunay_.insert(flat.front());
        if (flat.size() == 2) delaunay_.insert_constraint(flat[0], flat[1]);
        for (std::size_t i = 0; flat.size() > 2 && i < flat.size(); ++i)
            delaunay_.insert_constraint(flat[i], flat[(i + 1) % flat.size()]);
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
    Plane plane_;
    Delaunay delaunay_;
};

Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 v = to_double(mesh.vertices[mesh.triangles[triangle][i]]);
        corners[i] = ExactPoint(v.x, v.y, v.z);
    }
    return corners;
}

std::vector<Piece> cut(const TriangleMesh& mesh, std::uint32_t triangle, std::span<const std::uint32_t> others)
{
    const Corners corners = corners_of(mesh, triangle);
    CutTriangle pieces(corners);
    for (const std::uint32_t other : others)
        pieces.add(shared_corners(corners, corners_of(mesh, other)));
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
