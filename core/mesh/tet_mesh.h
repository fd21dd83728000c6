#pragma once

#include "core/mesh/triangle_mesh.h"
#include "kernels/layouts/layout.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Corners of a tet's faces, as in kernels/layouts/faces.h: counter-clockwise as seen from inside the tet.
inline constexpr std::array<std::array<std::uint32_t, 3>, 4> face_corners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// A half-face is one side of a face: tet << 2 | local face. NO_HALF_FACE outside the domain.
[[nodiscard]] constexpr std::uint32_t make_half_face(std::uint32_t tet, std::uint32_t face)
{
    return tet << 2 | face;
}
[[nodiscard]] constexpr std::uint32_t half_face_tet(std::uint32_t half_face)
{
    return half_face >> 2;
}
[[nodiscard]] constexpr std::uint32_t half_face_index(std::uint32_t half_face)
{
    return half_face & 3u;
}

/// One tetrahedron. Local face i is opposite vertex i.
struct Tet {
    std::array<std::uint32_t, 4> vertices;
    std::array<std::uint32_t, 4>
        neighbours;                     ///< the same face seen from its other side, or NO_HALF_FACE on the boundary
    std::array<std::uint32_t, 4> faces; ///< the input triangle that the face is a part of (occlusive), or FREE_FACE

    friend bool operator==(const Tet&, const Tet&) = default;
};

/// A tetrahedralization of the domain.
/// Every tet has det(V1-V0, V2-V0, V3-V0) < 0, the orientation of the paper's Table 2 (GRAPP 2017, section 3.2);
/// half-faces name each other; both sides of a face carry the same input triangle.
struct TetMesh {
    std::vector<Float3> vertices;
    std::vector<Tet> tets;

    friend bool operator==(const TetMesh&, const TetMesh&) = default;
};

/// The first defect of a tet mesh, and how many of its kind there are.
struct TetMeshDefect {
    enum class Kind {
        bad_index,            ///< a vertex, half-face or input triangle that does not exist
        asymmetric_neighbour, ///< a neighbour that does not name the tet back, or shares other vertices
        inverted,             ///< det > 0 in exact arithmetic on the stored floats
        flat,                 ///< det = 0 in exact arithmetic on the stored floats
        asymmetric_face,      ///< the two sides of a face name different input triangles
        uncovered_triangle,   ///< an input triangle whose occlusive faces do not add up to its area
        open_boundary,        ///< the volumes of the tets do not sum to the domain's
    };
    Kind kind;
    std::uint64_t first; ///< index of the first tet (or input triangle) concerned
    std::uint64_t count; ///< how many are concerned
    std::string what;    ///< a sentence that says so, with numbers
};

/// Checks structure (indices, half-faces, faces) and exact orientation. Linear in the number of tets.
/// triangle_count: number of input triangles that faces may name.
[[nodiscard]] std::optional<TetMeshDefect> find_defect(const TetMesh& mesh, std::size_t triangle_count);

/// Checks that the occlusive faces of each input triangle add up to its area (relative 1e-4 of its area, or 1e-12 of
/// the domain's, and 2^-21 of its perimeter: Steiner points are rounded to float) and that it has some, and that the
/// tets' volumes sum to the box's (relative 1e-6).
[[nodiscard]] std::optional<TetMeshDefect> find_gap(const TetMesh& mesh, const TriangleMesh& triangles,
                                                    Double3 box_size);

/// Which tets rays from outside can reach: those that a chain of free faces joins to the domain's boundary. The others
/// are inside closed objects.
[[nodiscard]] std::vector<bool> reached_tets(const TetMesh& mesh);

/// Counts each face once, not once per side; the domain's boundary is not free.
struct TetMeshCounts {
    std::uint64_t tets = 0;
    std::uint64_t occlusive_faces = 0;
    std::uint64_t free_faces = 0;
    std::uint64_t boundary_faces = 0;
    std::uint64_t reached_tets = 0; ///< see reached_tets()
};
[[nodiscard]] TetMeshCounts count_faces(const TetMesh& mesh);

} // namespace tetrace
