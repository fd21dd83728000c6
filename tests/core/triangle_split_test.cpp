#include "core/bvh/bvh.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr Box everywhere = {{-64, -64, -64}, {64, 64, 64}};

Float3 point_of(const Float3 (&corners)[3], float u, float v)
{
    Float3 point;
    for (int axis = 0; axis < 3; ++axis)
        point[axis] =
            corners[0][axis] + u * (corners[1][axis] - corners[0][axis]) + v * (corners[2][axis] - corners[0][axis]);
    return point;
}

} // namespace

TEST(TriangleSplit, each_point_of_the_triangle_is_in_a_part)
{
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const Float3 corners[3] = {random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
        const int axis = static_cast<int>(random.below(3));
        const float position = random.between(-1, 1);
        const auto parts = split_triangle(corners, axis, position, everywhere);
        const float u = random.unit();
        const Float3 point = point_of(corners, u, (1 - u) * random.unit());
        // rounding of the point itself: three roundings of numbers below 4
        const Box side = grown(point[axis] < position ? parts.below : parts.above, 0x1p-20);
        EXPECT_TRUE(contains(side, {point, point})) << "case " << i;
    }
}

TEST(TriangleSplit, parts_stay_on_their_side_and_in_the_box)
{
    Random random(8);
    for (int i = 0; i < 2000; ++i) {
        const Float3 corners[3] = {random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
        const Box box = {{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
        const auto parts = split_triangle(corners, 1, 0.25f, box);
        EXPECT_TRUE(contains(box, parts.below));
        EXPECT_TRUE(contains(box, parts.above));
        EXPECT_LE(parts.below.high.y, 0.25f);
        EXPECT_GE(parts.above.low.y, 0.25f);
    }
}

// What a cut of only the triangle's box would not give: the parts of a diagonal one are smaller along the other axes.
TEST(TriangleSplit, the_triangle_is_cut_and_not_its_box)
{
    const Float3 corners[3] = {{0, 0, 0}, {1, 1, 0}, {1, 1, 1}};
    const auto parts = split_triangle(corners, 0, 0.25f, everywhere);
    EXPECT_EQ(parts.below.high.x, 0.25f);
    EXPECT_NEAR(parts.below.high.y, 0.25f, 1e-6f);
    EXPECT_NEAR(parts.below.high.z, 0.25f, 1e-6f);
    EXPECT_NEAR(parts.above.low.y, 0.25f, 1e-6f);
    EXPECT_EQ(parts.above.high, (Float3{1, 1, 1}));
}

TEST(TriangleSplit, a_side_without_any_of_it_is_empty)
{
    const Float3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_TRUE(is_empty(split_triangle(corners, 0, 2, everywhere).above));
    EXPECT_TRUE(is_empty(split_triangle(corners, 0, -1, everywhere).below));
    EXPECT_TRUE(is_empty(split_triangle(corners, 0, 0.5f, {{5, 5, 5}, {6, 6, 6}}).below));
}

TEST(TriangleSplit, what_lies_in_the_plane_is_in_both_parts)
{
    const Float3 corners[3] = {{0, 0, 0.5f}, {1, 0, 0.5f}, {0, 1, 0.5f}};
    const auto parts = split_triangle(corners, 2, 0.5f, everywhere);
    EXPECT_EQ(parts.below, (Box{{0, 0, 0.5f}, {1, 1, 0.5f}}));
    EXPECT_EQ(parts.below, parts.above);
}
