#pragma once

#include "core/base/exact.h"
#include "core/mesh/entry_grid.h"
#include "core/mesh/scene.h"
#include "core/mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

namespace tetrace::test {

/// The occlusive faces of a mesh: corners in a fixed order, and the triangle that the face is a part of. Sorted.
using FixedFace = std::tuple<std::array<std::array<float, 3>, 3>, std::uint32_t>;
[[nodiscard]] inline std::vector<FixedFace> fixed_faces(const TetMesh& mesh)
{
    std::vector<FixedFace> faces;
    for (const Tet& tet : mesh.tets)
        for (std::uint32_t face = 0; face < 4; ++face) {
            if (tet.faces[face] == FREE_FACE) continue;
            std::array<std::array<float, 3>, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i) {
                const Float3 p = mesh.vertices[tet.vertices[face_corners[face][i]]];
                corners[i] = {p.x, p.y, p.z};
            }
            std::sort(corners.begin(), corners.end());
            faces.emplace_back(corners, tet.faces[face]);
        }
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// Expects that the boundary faces cover each side of the domain once: without a gap, and their areas add up.
inline void expect_covered_sides(const TetMesh& mesh, const Domain& domain)
{
    const EntryGrid grid = make_entry_grid(domain, mesh);
    const Double3 size = to_double(domain.high()) - to_double(domain.low());
    const std::array<double, 3> areas = {size.y * size.z, size.z * size.x, size.x * size.y};
    for (std::uint32_t side = 0; side < 6; ++side) {
        double area = 0;
        for (const std::uint32_t half_face : faces_of_side(grid, side)) {
            const auto at = [&](std::size_t i) {
                return to_double(mesh.vertices[mesh.tets[half_face_tet(half_face)]
                                                   .vertices[face_corners[half_face_index(half_face)][i]]]);
            };
            area += 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
        }
        EXPECT_NEAR(area, areas[side / 2], 1e-9 * areas[side / 2]);
    }
}

/// Expects sound tets of the scene's domain, with the occlusive faces that the scene has: then an exact ray hits the
/// same triangles in both.
inline void expect_same_domain(const TetMesh& mesh, const Scene& scene)
{
    const auto defect = find_defect(mesh, scene.mesh.triangles.size());
    EXPECT_FALSE(defect) << defect->what;
    const auto gap = find_gap(mesh, scene.mesh, to_double(scene.domain.high()) - to_double(scene.domain.low()));
    EXPECT_FALSE(gap) << gap->what;
    EXPECT_NO_THROW(expect_covered_sides(mesh, scene.domain));
    for (const Float3 v : mesh.vertices)
        EXPECT_EQ(snap_to_grid(v), v);
    EXPECT_EQ(fixed_faces(mesh), fixed_faces(scene.tets));
}

} // namespace tetrace::test
