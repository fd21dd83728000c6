#pragma once

#include "core/base/exact.h"
#include "core/mesh/face_corners.h"
#include "core/mesh/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

namespace tetrace::test {

/// The faces of a mesh that are occlusive, or on the domain's boundary: corners in a fixed order, and the triangle that
/// the face is a part of. Sorted.
using FixedFace = std::tuple<std::array<std::array<float, 3>, 3>, std::uint32_t, bool>;
[[nodiscard]] inline std::vector<FixedFace> fixed_faces(const TetMesh& mesh)
{
    std::vector<FixedFace> faces;
    for (const Tet& tet : mesh.tets)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const bool boundary = tet.links[face] == NO_LINK;
            if (tet.faces[face] == FREE_FACE && !boundary) continue;
            std::array<std::array<float, 3>, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i) {
                const Float3 p = mesh.vertices[tet.vertices[face_corners[face][i]]];
                corners[i] = {p.x, p.y, p.z};
            }
            std::sort(corners.begin(), corners.end());
            faces.emplace_back(corners, tet.faces[face], boundary);
        }
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// Expects sound tets of the scene's domain, with the occlusive and boundary faces that the scene has: then an exact
/// ray hits the same triangles in both.
inline void expect_same_domain(const TetMesh& mesh, const Scene& scene)
{
    const auto defect = find_defect(mesh, scene.mesh.triangles.size());
    EXPECT_FALSE(defect) << defect->what;
    const auto gap = find_gap(mesh, scene.mesh, to_double(scene.domain.high()) - to_double(scene.domain.low()));
    EXPECT_FALSE(gap) << gap->what;
    EXPECT_NO_THROW(static_cast<void>(make_entry_grid(scene.domain, mesh)));
    for (const Float3 v : mesh.vertices)
        EXPECT_EQ(snap_to_grid(v), v);
    EXPECT_EQ(fixed_faces(mesh), fixed_faces(scene.tets));
}

} // namespace tetrace::test
