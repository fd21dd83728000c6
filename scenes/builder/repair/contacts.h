#pragma once

#include "core/mesh/triangle_mesh.h"

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

/// Where triangles come near each other.
struct Contacts {
    std::map<Edge, std::vector<std::uint32_t>> on_edges;    ///< vertices near an edge, between its ends
    std::vector<std::vector<std::uint32_t>> in_triangles;   ///< of each triangle: vertices near it, away from its edges
    std::vector<std::vector<std::uint32_t>> near_triangles; ///< of each triangle
};

/// Moves each vertex to the first one within the distance, so that no two are nearer. Triangles may lose their area,
/// and some vertices are then of no triangle.
void merge_near_vertices(TriangleMesh& mesh, double distance);

/// Adds a vertex where edges pass each other within the tolerance and where an edge crosses a triangle, unless one is
/// within half the tolerance; then finds the vertices within the tolerance of each edge and triangle. mesh: as
/// merge_near_vertices() left it, with half the tolerance, and without degenerate triangles.
[[nodiscard]] Contacts find_contacts(TriangleMesh& mesh, double tolerance);

} // namespace tetrace
