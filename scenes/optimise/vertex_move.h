#pragma once

#include "scenes/optimise/editable_mesh.h"
#include "scenes/optimise/shape.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// The tets of a free vertex, and the edges of its link. The free faces that have the vertex are the triangles of it
/// and these edges; boundary faces cost nothing.
struct VertexStar {
    struct LinkEdge {
        std::uint32_t p, q;
        std::uint32_t left, right; ///< the link's triangles on both sides are p q left and p q right
    };
    std::vector<std::uint32_t> tets;
    std::vector<LinkEdge> edges;

    /// Sum of the areas of the free faces that have the vertex, were it at `at`.
    [[nodiscard]] double cost(const EditableMesh& mesh, Double3 at) const
    {
        double sum = 0;
        for (const LinkEdge& edge : edges)
            sum += area(at, mesh.point(edge.p), mesh.point(edge.q));
        return sum;
    }
};

/// Finds the star of a free vertex. False if it has more than `most` tets.
bool find_star(EditableMesh& mesh, std::uint32_t vertex, std::size_t most, VertexStar& star);

/// Where the sum of the areas of the triangles of a point and these edges is least: each area is half the edge's length
/// times the point's distance from its line, and so convex; each step solves the weighted least squares that have the
/// same gradient (Weiszfeld 1937, for lines). from: its start. sides: of the box, in whose planes it stays, exactly.
/// Not rounded.
[[nodiscard]] Double3 cheapest_point(const EditableMesh& mesh, std::span<const VertexStar::LinkEdge> edges,
                                     BoxSides sides, Double3 from, int steps);

/// Rounded to a float on the grid.
[[nodiscard]] Double3 rounded_point(Double3 point);

/// Moves a free vertex towards its cheapest point on the sides of the box that it is on: the whole way, or the half,
/// the quarter... of it where the whole way is not possible. Returns by how much cost fell; 0 if the vertex stays,
/// since no move lowers it by more than `least`.
double try_move(EditableMesh& mesh, std::uint32_t vertex, double least, VertexStar& scratch);

} // namespace tetrace
