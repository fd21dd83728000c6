#include "scenes/bvh_builder.h"

#include "core/error.h"
#include "kernels/layout.h"
#include "scenes/procedural.h"
#include "tests/random.h"

#include <gtest/gtest.h>

namespace tetrace {
namespace {

// Long, thin triangles through one another in all directions: their boxes overlap nearly everywhere.
TriangleMesh needles(std::uint32_t count)
{
    test::Random random(20);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < count; i++) {
        const Float3 a = random.point(-0.5f, 0.5f);
        const Float3 b = random.point(-0.5f, 0.5f);
        mesh.vertices.insert(mesh.vertices.end(), {a, b, {b.x + 0.002f, b.y, b.z + 0.002f}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

TEST(BvhBuilder, tree_of_a_surface_is_whole)
{
    const TriangleMesh mesh = make_cubes(8).mesh;
    const BuiltBvh built = build_bvh(mesh);
    EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    EXPECT_FALSE(built.balanced);
    EXPECT_LE(depth_of(built.bvh), BVH2_STACK);
}

TEST(BvhBuilder, needles_are_split)
{
    const TriangleMesh mesh = needles(1000);
    const BuiltBvh built = build_bvh(mesh);
    EXPECT_EQ(find_defect(built.bvh, mesh), std::nullopt);
    EXPECT_GT(built.spatial_splits, 100u);
    EXPECT_EQ(built.bvh.references.size(), 1000 + built.spatial_splits);
}

} // namespace
} // namespace tetrace
