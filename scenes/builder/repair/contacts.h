#pragma once

#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tetrace {

/// Two vertices, the lower number first.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

[[nodiscard]] inline Edge edge_of(std::uint32_t a, std::uint32_t b)
{
    return std::minmax(a, b);
}

/// The edge from corner i of a triangle to the next.
[[nodiscard]] inline Edge side_of(const std::array<std::uint32_t, 3>& triangle, std::size_t i)
{
    return edge_of(triangle[i], triangle[(i + 1) % 3]);
}

/// Where triangles come near each other.
struct Contacts {
    std::map<Edge, std::vector<std::uint32_t>> on_edges;    ///< vertices near an edge, between its ends
    std::vector<std::vector<std::uint32_t>> in_triangles;   ///< of each triangle: vertices near it, away from its edges
    std::vector<std::vector<std::uint32_t>> near_triangles; ///< of each triangle
};

/// Moves each vertex of the chosen triangles to the first such one within the distance, so that no two of these are
/// nearer. Triangles may lose their area. Vertices of no triangle go.
void merge_near_vertices(TriangleMesh& mesh, double distance, const std::vector<bool>& chosen);

/// Adds a vertex where edges of the chosen triangles pass each other within the tolerance and where one crosses another
/// such triangle, unless a vertex is within half the tolerance; then finds the vertices within the tolerance of these
/// edges and triangles. mesh: as merge_near_vertices() left it, with half the tolerance, and without degenerate
/// triangles.
[[nodiscard]] Contacts find_contacts(TriangleMesh& mesh, double tolerance, const std::vector<bool>& chosen);

} // namespace tetrace
