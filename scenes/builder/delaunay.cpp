#include "scenes/builder/delaunay.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace tetrace {

namespace {

using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Predicates>;
using Points = CGAL::Triangulation_data_structure_3<Vertex, CGAL::Delaunay_triangulation_cell_base_3<Predicates>>;

/// The smallest corner first, then the smallest of the others that an even permutation can bring next.
TetCorners in_order(TetCorners tet)
{
    const auto least = static_cast<std::size_t>(std::ranges::min_element(tet) - tet.begin());
    if (least != 0) {
        std::swap(tet[0], tet[least]);
        std::swap(tet[least == 1 ? 2 : 1], tet[least == 3 ? 2 : 3]); // the permutation stays even
    }
    std::rotate(tet.begin() + 1, std::min_element(tet.begin() + 1, tet.end()), tet.end());
    return tet;
}

} // namespace

std::vector<TetCorners> delaunay_tets(const std::vector<Float3>& points)
{
    std::vector<std::pair<Predicates::Point_3, std::uint32_t>> numbered;
    numbered.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
        numbered.emplace_back(Predicates::Point_3(points[i].x, points[i].y, points[i].z), i);
    const CGAL::Delaunay_triangulation_3<Predicates, Points> made(numbered.begin(), numbered.end());
    std::vector<TetCorners> tets;
    if (made.dimension() < 3) return tets;
    for (const auto cell : made.finite_cell_handles()) {
        TetCorners tet{};
        for (int i = 0; i < 4; ++i)
            tet[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
        tets.push_back(in_order(tet));
    }
    std::ranges::sort(tets);
    return tets;
}

} // namespace tetrace
