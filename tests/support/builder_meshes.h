#pragma once

#include "core/base/exact.h"
#include "core/mesh/domain.h"
#include "core/mesh/entry_grid.h"
#include "core/mesh/scene.h"
#include "scenes/builder/build.h"
#include "tests/support/cut_anew.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace tetrace::test {

/// Of unit legs.
[[nodiscard]] inline TriangleMesh tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// The surface of a box is a cube with large flat regions, each cut into 2 n n triangles.
[[nodiscard]] inline TriangleMesh flat_cube(std::uint32_t n)
{
    std::vector<float> line;
    for (std::uint32_t i = 0; i <= n; ++i)
        line.push_back(0.3f + 0.7f * static_cast<float>(i) / static_cast<float>(n));
    return domain_surface({DomainKind::tight, n, {line, line, line}});
}

/// An octahedron of radius 1 whose triangles are cut into four, that many times.
[[nodiscard]] inline TriangleMesh sphere(int subdivisions)
{
    TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int i = 0; i < subdivisions; ++i) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, is_new] =
                middles.try_emplace(std::minmax({a, b}), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new)
                mesh.vertices.push_back(
                    to_float(normalized(to_double(mesh.vertices[a]) + to_double(mesh.vertices[b]))));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = finer;
    }
    return mesh;
}

/// A box of 12 triangles, outwards.
[[nodiscard]] inline TriangleMesh box(Float3 low, Float3 high)
{
    return domain_surface({DomainKind::tight, 1, {{{low.x, high.x}, {low.y, high.y}, {low.z, high.z}}}});
}

[[nodiscard]] inline TriangleMesh moved(TriangleMesh mesh, Float3 by, float scale = 1)
{
    for (Float3& v : mesh.vertices)
        v = {scale * v.x + by.x, scale * v.y + by.y, scale * v.z + by.z};
    return mesh;
}

/// Both, with the second's triangles last.
[[nodiscard]] inline TriangleMesh joined(TriangleMesh first, const TriangleMesh& second)
{
    const auto offset = static_cast<std::uint32_t>(first.vertices.size());
    first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const auto& [a, b, c] : second.triangles)
        first.triangles.push_back({a + offset, b + offset, c + offset});
    return first;
}

/// Those triangles of a mesh whose corners all have z >= 0.
[[nodiscard]] inline TriangleMesh upper_half(TriangleMesh mesh)
{
    std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
        return std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return mesh.vertices[v].z < 0; });
    });
    return mesh;
}

/// Two triangles that cross, far from any shared vertex.
[[nodiscard]] inline TriangleMesh crossing_pair()
{
    return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1}}, {{0, 1, 2}, {3, 4, 5}}};
}

/// As the text of an OFF file.
[[nodiscard]] inline std::string to_off(const TriangleMesh& mesh)
{
    std::ostringstream text;
    text.precision(9);
    text << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
    for (const Float3 v : mesh.vertices)
        text << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (const auto& [a, b, c] : mesh.triangles)
        text << "3 " << a << ' ' << b << ' ' << c << '\n';
    return text.str();
}

/// A folder for a mesh and the scene that is built of it.
class Builder : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& bytes) const
    {
        write_file(folder_ / name, bytes);
        return folder_ / name;
    }
    [[nodiscard]] BuilderOptions options(const TriangleMesh& mesh, DomainKind domain, const std::string& switches) const
    {
        return {write("mesh.off", to_off(mesh)), folder_ / "out.tet", "", domain, 4, switches};
    }

    TemporaryFolder folder_;
};

[[nodiscard]] inline bool is_boundary_corner(const Scene& scene, Float3 corner)
{
    return std::find(scene.tets.vertices.begin(), scene.tets.vertices.end(), corner) != scene.tets.vertices.end();
}

/// Expects a scene that can be packed and walked: sound tets without gaps, on the grid, with every corner of the
/// domain, of its squares where nothing moved them, and of the mesh.
inline void expect_sound(const Scene& scene)
{
    const auto defect = find_defect(scene.tets, scene.mesh.triangles.size());
    EXPECT_FALSE(defect) << defect->what;
    const auto gap = find_gap(scene.tets, scene.mesh, to_double(scene.domain.high()) - to_double(scene.domain.low()));
    EXPECT_FALSE(gap) << gap->what;
    EXPECT_NO_THROW(static_cast<void>(make_entry_grid(scene.domain, scene.tets)));
    for (const Float3 v : scene.tets.vertices)
        EXPECT_EQ(snap_to_grid(v), v);
    const bool has_its_squares = scene.build.optimised.tets == TetsKind::cdt && scene.build.order < 100;
    for (const Float3 corner : domain_surface(has_its_squares ? scene.domain : cut_anew(scene.domain, 1)).vertices)
        EXPECT_TRUE(is_boundary_corner(scene, corner));
    for (const Float3 vertex : scene.mesh.vertices)
        EXPECT_TRUE(is_boundary_corner(scene, vertex)) << "an input vertex moved";
}

} // namespace tetrace::test
