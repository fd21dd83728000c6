#pragma once

#include "core/mesh/tet_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// A set of sides of the domain's box, a bit each: 2 axis + (1 on the high side).
using BoxSides = std::uint32_t;
inline constexpr BoxSides all_box_sides = 0x3F;

/// Whether a point that stays on these sides keeps its coordinate along the axis.
[[nodiscard]] constexpr bool holds_axis(BoxSides sides, int axis)
{
    return (sides >> (2 * axis) & 3u) != 0;
}

/// reached: a chain of free faces leads from the domain's boundary to the tet, so that rays from outside may reach it;
/// or all tets are to be changed.
enum class TetState : std::uint8_t { unused, hidden, reached };

/// free: the vertex is on no occlusive face, its tets are reached, it is not a corner of the domain, and its boundary
/// faces lie on the sides of a box. at_wall: it would be free, were there no wall of a region (regions.h) at it.
enum class VertexKind : std::uint8_t { held, at_wall, free };

/// A tet mesh as the optimiser keeps it. One entry a tet, or a vertex.
struct MeshArrays {
    std::vector<Tet> tets;
    std::vector<TetState> states;
    std::vector<std::uint32_t> tet_changed; ///< see EditableMesh::round

    std::vector<Double3> points; ///< of floats
    std::vector<VertexKind> kinds;
    std::vector<BoxSides> box_sides;
    std::vector<std::uint32_t> vertex_changed;
};

/// mesh: sound (find_defect and find_gap find nothing). all: whether the tets inside closed objects count as reached.
[[nodiscard]] MeshArrays arrays_of(const TetMesh& mesh, bool all = false);

/// The mesh without unused tets and vertices; the others keep their order.
[[nodiscard]] TetMesh mesh_of(const MeshArrays& arrays);

/// The sides of the box on which all these vertices lie.
[[nodiscard]] inline BoxSides common_sides(const MeshArrays& arrays, const std::array<std::uint32_t, 3>& vertices)
{
    return arrays.box_sides[vertices[0]] & arrays.box_sides[vertices[1]] & arrays.box_sides[vertices[2]];
}

/// Sum of the areas of the free faces of the tets that rays reach. What the optimiser lowers.
[[nodiscard]] double free_area(const MeshArrays& arrays);

/// Area of the domain's boundary.
[[nodiscard]] double boundary_area(const MeshArrays& arrays);

} // namespace tetrace
