#pragma once

#include "scenes/optimise/vertex_star.h"

namespace tetrace {

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
