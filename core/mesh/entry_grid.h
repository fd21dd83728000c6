#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// How near to a square a boundary face is that the square lists: farther than rounding can put a camera's ray into a
/// wrong square (docs/spec/data-and-rays.md, D4; three times the largest b of project.md, P10).
inline constexpr double entry_margin = 0x1p-15;

/// By square of the domain's sides, the boundary faces that touch it or are within entry_margin of it; then by side,
/// each face of the side once. As half-faces into the tet mesh.
/// Square index: (side * n + j) * n + i with side = 2 axis + (1 on the high side), i along axis + 1, j along axis + 2.
/// A side's index: 6 n n + side. A square's faces are in the order of the share of it that they cover, the largest
/// first, in sixteenths; faces with equal shares in the order of their half-faces.
struct EntryGrid {
    std::vector<std::uint32_t> ranges;     ///< 6 n n + 7 offsets into half-faces
    std::vector<std::uint32_t> half_faces; ///< tet << 2 | local face of a boundary face
};

/// Faces may lie across any number of the domain's squares. Time and memory: linear in the faces and in the squares
/// that they touch. The same on every machine.
/// Throws Error{invalid_input} if a square touches no boundary face, or a boundary face is on no side.
[[nodiscard]] EntryGrid make_entry_grid(const Domain& domain, const TetMesh& mesh);

/// The boundary faces of a side, each once.
[[nodiscard]] inline std::span<const std::uint32_t> faces_of_side(const EntryGrid& grid, std::uint32_t side)
{
    const std::size_t place = grid.ranges.size() - 7 + side;
    return std::span(grid.half_faces).subspan(grid.ranges[place], grid.ranges[place + 1] - grid.ranges[place]);
}

/// Checks what docs/spec/project.md, P10, asks of the domain's sides, so that no ray sees a boundary face turned over:
/// the domain is in [-1, 1]^3, and each boundary face is as high, and the mesh as far from each side, as three times
/// tie_bound() for origins up to 3 radii of the mesh's bounding sphere from its centre. No camera is farther away.
/// grid: of the scene, by make_entry_grid().
/// Returns an empty string, or what is wrong and where, with both numbers and what to do.
[[nodiscard]] std::string find_weak_side(const Scene& scene, const EntryGrid& grid);

} // namespace tetrace
