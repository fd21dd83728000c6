#include "scenes/builder/repair/weld.h"

#include "core/base/exact.h"
#include "scenes/builder/repair/contacts.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <map>

// The idea is that of snap rounding (Hobby, "Practical segment intersection with finite precision output", 1999):
// what passes near a vertex passes through it.

namespace tetrace {
namespace {

using Triple = std::array<std::uint32_t, 3>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Flat = Kernel::Point_2;
using Overlay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>,
                                         CGAL::Constrained_triangulation_face_base_2<Kernel>>,
    CGAL::Exact_predicates_tag>;

using Polygon = std::vector<Flat>;

// Whether a point is inside, or on some of the sides.
bool is_inside(const Polygon& polygon, const Flat& point)
{
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        Flat low = polygon[i], high = polygon[(i + 1) % polygon.size()];
        if (low.y() > high.y()) std::swap(low, high);
        if (low.y() <= point.y() && point.y() < high.y() && CGAL::left_turn(low, high, point)) inside = !inside;
    }
    return inside;
}

// A triangle's plane, seen along the axis that its normal leans to most.
class FlatView {
public:
    FlatView(const TriangleMesh& mesh, const Triple& triangle) : on_plane_(to_double(mesh.vertices[triangle[0]]))
    {
        normal_ =
            cross(to_double(mesh.vertices[triangle[1]]) - on_plane_, to_double(mesh.vertices[triangle[2]]) - on_plane_);
        for (int axis = 1; axis < 3; ++axis)
            if (std::abs(part(normal_, axis)) > std::abs(part(normal_, along_))) along_ = axis;
    }

    [[nodiscard]] Flat flat(Float3 point) const { return {point[(along_ + 1) % 3], point[(along_ + 2) % 3]}; }
    [[nodiscard]] Float3 lifted(const Flat& point) const
    {
        const int u = (along_ + 1) % 3, v = (along_ + 2) % 3;
        const double slope =
            part(normal_, u) * (point.x() - part(on_plane_, u)) + part(normal_, v) * (point.y() - part(on_plane_, v));
        Float3 result;
        result[along_] = static_cast<float>(part(on_plane_, along_) - slope / part(normal_, along_));
        result[u] = static_cast<float>(point.x());
        result[v] = static_cast<float>(point.y());
        return snap_to_grid(result);
    }
    // Whether the triangle's own order of corners is clockwise there.
    [[nodiscard]] bool is_turned() const { return part(normal_, along_) < 0; }

private:
    static double part(Double3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

    Double3 on_plane_, normal_;
    int along_ = 0;
};

// A triangle's outline and the vertices in it, triangulated.
class Pieces {
public:
    Pieces(TriangleMesh& mesh, const Triple& triangle, const std::vector<std::uint32_t>& outline,
           const std::vector<std::uint32_t>& inner)
        : mesh_(mesh), view_(mesh, triangle)
    {
        for (const std::uint32_t vertex : outline) {
            outline_.push_back(view_.flat(mesh.vertices[vertex]));
            insert(vertex);
        }
        for (const std::uint32_t vertex : inner)
            if (is_inside(outline_, view_.flat(mesh.vertices[vertex]))) insert(vertex);
        for (std::size_t i = 0; i < outline.size(); ++i)
            join(outline[i], outline[(i + 1) % outline.size()]);
    }

    [[nodiscard]] bool has(std::uint32_t vertex) const { return handles_.contains(vertex); }
    // Makes an edge between two vertices, if both are here.
    void join(std::uint32_t a, std::uint32_t b)
    {
        const auto from = handles_.find(a), to = handles_.find(b);
        if (a != b && from != handles_.end() && to != handles_.end())
            overlay_.insert_constraint(from->second, to->second);
    }
    // Adds the pieces to the mesh, and a vertex wherever edges cross.
    void add_to_mesh()
    {
        const bool turned = view_.is_turned();
        for (const auto face : overlay_.finite_face_handles())
            if (is_inside(outline_, CGAL::centroid(overlay_.triangle(face))))
                mesh_.triangles.push_back({vertex_of(face->vertex(0)), vertex_of(face->vertex(turned ? 2 : 1)),
                                           vertex_of(face->vertex(turned ? 1 : 2))});
    }

private:
    void insert(std::uint32_t vertex)
    {
        if (has(vertex)) return;
        const std::size_t before = overlay_.number_of_vertices();
        const auto handle = overlay_.insert(view_.flat(mesh_.vertices[vertex]));
        if (overlay_.number_of_vertices() == before) return; // over another one, which is not near in space
        handle->info() = vertex;
        handles_.emplace(vertex, handle);
    }
    std::uint32_t vertex_of(Overlay::Vertex_handle handle)
    {
        const auto known = handles_.find(handle->info());
        if (known != handles_.end() && known->second == handle) return handle->info();
        handle->info() = static_cast<std::uint32_t>(mesh_.vertices.size());
        handles_.emplace(handle->info(), handle);
        mesh_.vertices.push_back(view_.lifted(handle->point()));
        return handle->info();
    }

    TriangleMesh& mesh_;
    FlatView view_;
    Polygon outline_;
    Overlay overlay_;
    std::map<std::uint32_t, Overlay::Vertex_handle> handles_;
};

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
    // The vertices along an edge, ends included.
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
        const std::vector<std::uint32_t> sides = outline(triangles[number]);
        const std::vector<std::uint32_t>& inner = contacts_.in_triangles[number];
        if (sides.size() == 3 && inner.empty()) {
            mesh_.triangles.push_back(triangles[number]);
            return;
        }
        Pieces pieces(mesh_, triangles[number], sides, inner);
        for (const std::uint32_t other : contacts_.near_triangles[number])
            draw(triangles, other, pieces);
        pieces.add_to_mesh();
    }
    // The edges of another triangle that run through this one, and the segment along which the two cross.
    void draw(const std::vector<Triple>& triangles, std::uint32_t other, Pieces& pieces) const
    {
        std::vector<std::uint32_t> shared;
        const auto note = [&](std::uint32_t vertex) {
            if (pieces.has(vertex)) shared.push_back(vertex);
        };
        const std::vector<std::uint32_t> sides = outline(triangles[other]);
        for (std::size_t i = 0; i < sides.size(); ++i) {
            pieces.join(sides[i], sides[(i + 1) % sides.size()]);
            note(sides[i]);
        }
        std::ranges::for_each(contacts_.in_triangles[other], note);
        if (shared.size() == 2) pieces.join(shared[0], shared[1]);
    }

    TriangleMesh& mesh_;
    Contacts contacts_;
};

} // namespace

void weld(TriangleMesh& mesh, std::vector<std::uint32_t>& origins, double tolerance, std::vector<bool> chosen)
{
    merge_near_vertices(mesh, tolerance / 2, chosen);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        if (a == b || b == c || c == a) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        chosen[kept] = chosen[i];
        origins[kept++] = origins[i];
    }
    mesh.triangles.resize(kept);
    origins.resize(kept);
    Cutter(mesh, find_contacts(mesh, tolerance, chosen)).cut(origins);
}

} // namespace tetrace
