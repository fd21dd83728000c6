// Lengths of uniform lines, by a law of integral geometry.
#include "bench/truth/uniform_lines.h"
#include "scenes/procedural.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/given_scene.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

LineTest tested(const GivenScene& given, const std::vector<CrossedTets>& walks, const CrossedScene& tets)
{
    UniformLines lines(given.scene, tets.mesh_of_packed());
    for (const CrossedTets& walk : walks)
        lines.add(walk);
    return lines.test();
}

} // namespace

TEST(UniformLines, have_the_mean_length_of_integral_geometry_in_each_group_of_tets)
{
    const GivenScene given{128, false, 6};
    const CrossedScene tets(given.scene, Method::project, Layout::half32);
    auto walks = tets.walks(make_rays(RayKind::random, given.source()));
    const LineTest right = tested(given, walks, tets);
    EXPECT_EQ(right.lines, 128u * 128);
    EXPECT_GT(right.groups, 200u);
    EXPECT_TRUE(right.passes()) << right.chi_square << " within " << right.reach();
    EXPECT_NEAR(right.mean_length / right.expected_length, 1, 0.02);

    for (CrossedTets& walk : walks) // as if the last tet of each were left out
        if (walk.tets.size() > 1) {
            walk.tets.pop_back();
            walk.places.pop_back();
        }
    EXPECT_FALSE(tested(given, walks, tets).passes());
}

TEST(UniformLines, other_rays_do_not_have_it)
{
    const GivenScene given{64, false, 6};
    const CrossedScene tets(given.scene, Method::project, Layout::half32);
    EXPECT_FALSE(tested(given, tets.walks(make_rays(RayKind::primary, given.source())), tets).passes());
}

TEST(UniformLines, are_not_judged_by_fewer_than_four_per_group)
{
    const GivenScene given{8, false, 6};
    const CrossedScene tets(given.scene, Method::project, Layout::half32);
    const LineTest few = tested(given, tets.walks(make_rays(RayKind::random, given.source())), tets);
    EXPECT_EQ(few.lines, 64u);
    EXPECT_FALSE(few.is_testable());
    EXPECT_TRUE(std::isfinite(few.chi_square));
}
