#include "core/rays/ray_start.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/device/given_quads.h"
#include "tests/support/given_scene.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const GivenScene& given()
{
    static const GivenScene made;
    return made;
}

float as_float(std::uint32_t bits)
{
    return std::bit_cast<float>(bits);
}

} // namespace

TEST(RayOffset, a_coordinate_moves_by_256_units_in_the_last_place)
{
    const Float3 moved = offset_point({0.75F, -0.25F, 0.5F}, {1, 1, 0});
    EXPECT_EQ(moved.x, 0.75F + 256 * 0x1p-24F);
    EXPECT_EQ(moved.y, -0.25F + 128 * 0x1p-25F) << "towards zero, units are half as large";
    EXPECT_EQ(moved.z, 0.5F);
}

TEST(RayOffset, near_zero_a_coordinate_moves_by_2_to_the_minus_16)
{
    EXPECT_EQ(offset_point({0, 0x1p-6F, -0x1p-6F}, {1, -1, 0.5F}).x, 0x1p-16F);
    EXPECT_EQ(offset_point({0, 0x1p-6F, -0x1p-6F}, {1, -1, 0.5F}).y, 0x1p-6F - 0x1p-16F);
    EXPECT_EQ(offset_point({0, 0x1p-6F, -0x1p-6F}, {1, -1, 0.5F}).z, -0x1p-6F + 0x1p-17F);
}

TEST(RayOffset, stays_on_the_grid)
{
    Random random(21);
    for (int i = 0; i < 10'000; ++i) {
        const Float3 point = random.point(-0.03F, 0.03F);
        const Float3 moved = offset_point(point, to_float(normalized(to_double(random.point(-1, 1)))));
        ASSERT_EQ(moved, snap_to_grid(moved));
    }
}

TEST(RayOffset, every_ray_starts_on_its_side_of_the_exact_triangle)
{
    const TriangleMesh& mesh = given().scene.mesh;
    int behind_before = 0;
    for (const RayKind kind : {RayKind::shadow, RayKind::ao, RayKind::diffuse})
        for (const GivenRay& ray : make_rays(kind, given().source()).rays) {
            const auto& [a, b, c] = mesh.triangles[ray.triangle];
            const Float3 ahead = to_float(to_double(ray.origin) + to_double(ray.direction) * 0.5);
            const auto side = [&](Float3 point) {
                return orientation(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], snap_to_grid(point));
            };
            ASSERT_EQ(side(offset_origin(ray, mesh)), side(ahead));
            behind_before += side(ray.origin) != side(ahead);
        }
    EXPECT_GT(behind_before, 100) << "without the offset, about half start on the wrong side of their triangle";
}

TEST(GivenRows, hold_the_rays_with_links_as_the_scene_is_packed)
{
    const RaySet set = make_rays(RayKind::ao, given().source());
    const auto quads = given_quads(set, given().packed);
    ASSERT_EQ(quads.size(), GIVEN_RAY_QUADS * set.rays.size());
    bool renumbered = false;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const GivenRay& ray = set.rays[i];
        const Quad &first = quads[i], &second = quads[set.rays.size() + i];
        EXPECT_EQ((Float3{as_float(first.x), as_float(first.y), as_float(first.z)}), ray.direction);
        EXPECT_EQ((Float3{as_float(second.x), as_float(second.y), as_float(second.z)}), ray.origin);
        EXPECT_EQ(as_float(second.w), ray.end);
        EXPECT_EQ(half_face_index(first.w), half_face_index(ray.half_face));
        EXPECT_EQ(given().mesh_of_packed[half_face_tet(first.w)], half_face_tet(ray.half_face));
        renumbered = renumbered || first.w != ray.half_face;
    }
    EXPECT_TRUE(renumbered);
}

TEST(GivenRows, rays_from_outside_have_no_link)
{
    const RaySet set = make_rays(RayKind::random, given().source());
    for (const auto& quads : {given_quads(set, given().packed), given_quads_offset(set, given().scene.mesh)})
        for (std::size_t i = 0; i < set.rays.size(); ++i) {
            ASSERT_EQ(quads[i].w, NO_HALF_FACE);
            ASSERT_EQ(as_float(quads[set.rays.size() + i].x), set.rays[i].origin.x) << "and no offset";
        }
}

TEST(GivenRows, of_another_scene_are_refused)
{
    RaySet set = make_rays(RayKind::ao, given().source());
    set.rays.front().half_face = make_half_face(given().packed.tet_count, 0);
    EXPECT_THROW((void)given_quads(set, given().packed), Error);
}

TEST(GivenRows, of_a_bvh_start_offset)
{
    const RaySet set = make_rays(RayKind::diffuse, given().source());
    const auto quads = given_quads_offset(set, given().scene.mesh);
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const Quad& second = quads[set.rays.size() + i];
        const Float3 origin{as_float(second.x), as_float(second.y), as_float(second.z)};
        ASSERT_NE(origin, set.rays[i].origin);
        // 256 units in the last place of numbers below 1 are at most 2^-16.
        ASSERT_LE(length(to_double(origin) - to_double(set.rays[i].origin)), 0x1p-16 * 1.0001);
        ASSERT_EQ(quads[i].w, NO_HALF_FACE);
    }
}
