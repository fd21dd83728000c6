#include "core/rays/entering.h"

#include "tests/support/given_scene.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const Domain unit_box{DomainKind::tight, 1, {{{0, 1}, {0, 1}, {0, 1}}}};

std::uint64_t walked(const std::vector<Hit>& hits)
{
    return static_cast<std::uint64_t>(
        std::ranges::count_if(hits, [](const Hit& hit) { return hit.face_id != NO_HIT || hit.steps > 0; }));
}

} // namespace

TEST(Entering, rays_enter_if_they_have_a_point_inside_ahead_of_them_and_before_their_end)
{
    EXPECT_TRUE(enters(unit_box, {-1, 0.5, 0.5}, {1, 0, 0}));
    EXPECT_FALSE(enters(unit_box, {-1, 0.5, 0.5}, {-1, 0, 0})) << "the box is in the other direction";
    EXPECT_FALSE(enters(unit_box, {-1, 0.5, 0.5}, {1, 2, 0})) << "it passes by";
    EXPECT_TRUE(enters(unit_box, {0.5, 0.5, 0.5}, {0, 0, -1})) << "from inside";
    EXPECT_FALSE(enters(unit_box, {-1, 1, 0.5}, {1, 0, 0})) << "along a side";
    EXPECT_FALSE(enters(unit_box, {-1, 0.5, 0.5}, {1, 0, 0}, 1)) << "it ends where the box begins";
    EXPECT_TRUE(enters(unit_box, {-1, 0.5, 0.5}, {1, 0, 0}, 1.25));
    EXPECT_FALSE(enters(unit_box, {1, 0.5, 0.5}, {1, 0, 0})) << "it leaves";
    EXPECT_TRUE(enters(unit_box, {1, 0.5, 0.5}, {-1, 0, 0}));
}

// At x = 0 the rays of the four columns are at y = 0.25, 0.75, 1.25 and 1.75.
TEST(Entering, the_rays_of_a_view_are_counted_by_pixel)
{
    const View view{{-1, 0, 0.5}, {1, 0.25F, 0}, {0, 0.5F, 0}, {0, 0, 0}};
    EXPECT_EQ(count_entering(unit_box, view, 4, 1), 2u) << "the box ends at y = 1";
    EXPECT_EQ(count_entering(unit_box, view, 4, 3), 6u) << "all rows are the same";
}

TEST(Entering, the_count_is_that_of_the_reference_kernel)
{
    GivenScene outside(128);
    outside.job.view.origin = {2 * outside.job.view.origin.x, 2 * outside.job.view.origin.y,
                               2 * outside.job.view.origin.z};
    const auto session = openmp_backend().open(0, {}, {&outside.scene.mesh, &outside.packed}, {.threads = 2});
    (void)session->trace(outside.job, outside.hits);
    const auto entering = count_entering(outside.scene.domain, outside.job.view, 128, 128);
    EXPECT_GT(entering, 1000u);
    EXPECT_LT(entering, 128u * 128 - 1000) << "from so far the box fills a part of the view";
    EXPECT_EQ(entering, walked(outside.hits));
    const GivenScene inside(32, true);
    EXPECT_EQ(count_entering(inside.scene.domain, inside.job.view, 32, 32), 32u * 32);
}

TEST(Entering, given_rays_count_as_the_kernel_walks_them)
{
    const GivenScene scene(64);
    const RaySet primary = make_rays(RayKind::primary, scene.source());
    EXPECT_EQ(count_entering(scene.scene.domain, primary.rays), walked(scene.hits));
    const RaySet diffuse = make_rays(RayKind::diffuse, scene.source());
    EXPECT_EQ(count_entering(scene.scene.domain, diffuse.rays), diffuse.rays.size()) << "they start at surfaces";
    const RaySet random = make_rays(RayKind::random, scene.source());
    EXPECT_EQ(count_entering(scene.scene.domain, random.rays), random.rays.size()) << "they are made to meet the box";
}
