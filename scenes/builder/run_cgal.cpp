#include "scenes/builder/run_cgal.h"

#include "scenes/builder/failure.h"

#include <fmt/format.h>

#if __has_include(<CGAL/make_conforming_constrained_Delaunay_triangulation_3.h>)
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/make_conforming_constrained_Delaunay_triangulation_3.h>

#include <bit>
#include <exception>
#include <map>
#include <new>
#include <unordered_map>

// Source of the method: Alliez, Rineau, Tournois, Cohen-Steiner et al., CGAL's package Constrained_triangulation_3.

namespace tetrace {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Conforming_constrained_Delaunay_triangulation_3<Kernel>;
using Cell = Triangulation::Triangulation::Cell_handle;
using Bits = std::array<std::uint64_t, 3>;

Bits bits_of(const Kernel::Point_3& point)
{
    // + 0.0: so that -0 counts as 0
    return {std::bit_cast<std::uint64_t>(point.x() + 0.0), std::bit_cast<std::uint64_t>(point.y() + 0.0),
            std::bit_cast<std::uint64_t>(point.z() + 0.0)};
}

struct Input {
    std::vector<Kernel::Point_3> points;
    std::vector<std::array<std::size_t, 3>> triangles;

    void add(const std::vector<Float3>& vertices)
    {
        for (const Float3 vertex : vertices) {
            const Double3 v = to_double(vertex);
            points.emplace_back(v.x, v.y, v.z);
        }
    }
    void add(const TriangleMesh& mesh)
    {
        const std::size_t first = points.size();
        add(mesh.vertices);
        for (const auto& [a, b, c] : mesh.triangles)
            triangles.push_back({first + a, first + b, first + c});
    }
};

// Numbers the vertices: those of the input as there, Steiner points after them.
class Numbers {
public:
    Numbers(const Input& input, const Triangulation& made)
    {
        std::map<Bits, std::int32_t> numbers;
        for (const auto& point : input.points) {
            numbers.emplace(bits_of(point), static_cast<std::int32_t>(points.size()));
            points.push_back({point.x(), point.y(), point.z()});
        }
        for (const auto vertex : made.triangulation().finite_vertex_handles()) {
            const auto& point = vertex->point();
            const auto [entry, is_new] = numbers.emplace(bits_of(point), static_cast<std::int32_t>(points.size()));
            if (is_new) points.push_back({point.x(), point.y(), point.z()});
            of_vertex_.emplace(&*vertex, entry->second);
        }
        std::int32_t cells = 0;
        for (const auto cell : made.triangulation().finite_cell_handles())
            of_cell_.emplace(&*cell, cells++);
    }

    std::vector<Double3> points;

    [[nodiscard]] std::int32_t of(const Cell& cell) const
    {
        const auto found = of_cell_.find(&*cell);
        return found == of_cell_.end() ? -1 : found->second;
    }
    [[nodiscard]] std::int32_t of_corner(const Cell& cell, int corner) const
    {
        return of_vertex_.at(&*cell->vertex(corner));
    }

private:
    std::unordered_map<const void*, std::int32_t> of_vertex_, of_cell_;
};

RawTets take(const Input& input, std::size_t surface_points, std::size_t mesh_triangles, const Triangulation& made)
{
    RawTets result;
    result.maker = "CGAL";
    result.input_points = surface_points;
    Numbers numbers(input, made);
    const auto& cells = made.triangulation();
    for (const auto cell : cells.finite_cell_handles()) {
        auto& tet = result.tets.emplace_back();
        auto& neighbours = result.neighbours.emplace_back();
        for (int i = 0; i < 4; ++i) {
            tet[static_cast<std::size_t>(i)] = numbers.of_corner(cell, i);
            neighbours[static_cast<std::size_t>(i)] = numbers.of(cell->neighbor(i));
        }
        if (cells.tetrahedron(cell).orientation() != CGAL::POSITIVE) ++result.flat_tets;
    }
    for (const auto& facet : made.constrained_facets()) {
        std::array<std::int32_t, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = numbers.of_corner(facet.first, (facet.second + 1 + static_cast<int>(i)) % 4);
        const auto triangle = static_cast<std::size_t>(made.face_constraint_index(facet));
        result.surface_faces.push_back({corners, triangle < mesh_triangles ? static_cast<std::int32_t>(triangle) : -1});
    }
    result.points = std::move(numbers.points);
    return result;
}

} // namespace

RawTets run_cgal(const TriangleMesh& mesh, const TriangleMesh& surface, const std::vector<Float3>& points)
{
    Input input;
    input.add(mesh);
    input.add(surface);
    const std::size_t surface_points = input.points.size();
    input.add(points);
    try {
        const Triangulation made(input.points, input.triangles);
        return take(input, surface_points, mesh.triangles.size(), made);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        const std::string_view all = failure.what();
        throw BuilderFailure(BUILDER_TETGEN_REFUSED, fmt::format("CGAL gave up: {}; {}, or repair the mesh",
                                                                 all.substr(0, all.find('\n')), try_other_switches));
    }
}

} // namespace tetrace

#else

namespace tetrace {

RawTets run_cgal(const TriangleMesh&, const TriangleMesh&, const std::vector<Float3>&)
{
    throw BuilderFailure(BUILDER_TETGEN_REFUSED, fmt::format("CGAL {} makes no tets, 6.1 and later do; {}",
                                                             TETRACE_CGAL_VERSION, try_other_switches));
}

} // namespace tetrace

#endif
