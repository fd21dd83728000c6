#include "core/base/exact.h"

#include "tests/support/random.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <cmath>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Rational = boost::multiprecision::cpp_rational;

// The same determinants over rationals, written from the definition.
Rational component(Float3 a, int axis)
{
    return Rational(static_cast<double>(a[axis]));
}
Rational determinant(const Rational (&m)[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}
int rational_orientation(Float3 a, Float3 b, Float3 c, Float3 d)
{
    Rational m[3][3];
    const Float3 points[3] = {b, c, d};
    for (int row = 0; row < 3; ++row)
        for (int axis = 0; axis < 3; ++axis)
            m[row][axis] = component(points[row], axis) - component(a, axis);
    return determinant(m).sign();
}

} // namespace

TEST(Exact, grid_keeps_floats_from_2_to_the_minus_16_up)
{
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const float x = std::ldexp(1 + random.unit(), -16 + static_cast<int>(random.below(20)));
        EXPECT_EQ(snap_to_grid(x), x);
        EXPECT_EQ(snap_to_grid(-x), -x);
    }
}

TEST(Exact, grid_rounds_smaller_floats_to_its_nearest_point)
{
    EXPECT_EQ(snap_to_grid(0x1.8p-41f), 0x1p-40f);
    EXPECT_EQ(snap_to_grid(0x1p-60f), 0.0f);
    EXPECT_FALSE(std::signbit(snap_to_grid(-0x1p-60f)));
    EXPECT_EQ(snap_to_grid(0x1.fffffep-17f), std::nearbyint(0x1.fffffep-17 * 0x1p40) * 0x1p-40);
}

TEST(Exact, orientation_agrees_with_rational_arithmetic_on_near_degenerate_points)
{
    Random random(2);
    int flat = 0;
    for (int i = 0; i < 20000; ++i) {
        const Float3 a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
        // A point of the plane, rounded: the estimate's sign is then worth nothing.
        const float u = random.unit(), v = random.unit();
        Float3 d{a.x + u * (b.x - a.x) + v * (c.x - a.x), a.y + u * (b.y - a.y) + v * (c.y - a.y),
                 a.z + u * (b.z - a.z) + v * (c.z - a.z)};
        if (i % 4 == 0) d = {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
        d = snap_to_grid(d);
        const int expected = rational_orientation(a, b, c, d);
        flat += expected == 0;
        ASSERT_EQ(orientation(a, b, c, d), expected) << "case " << i;
    }
    EXPECT_GT(flat, 0) << "no flat case was among them";
}

TEST(Exact, crossing_distinguishes_inside_edge_vertex_outside_and_before_the_origin)
{
    const Float3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    const Float3 down{0, 0, -1};
    const auto at = [&](float x, float y, float z = 1) { return cross_exactly({x, y, z}, down, a, b, c); };
    EXPECT_TRUE(at(0.25f, 0.25f).met);
    EXPECT_DOUBLE_EQ(at(0.25f, 0.25f).t, 1.0);
    EXPECT_TRUE(at(0.5f, 0.5f).met) << "on an edge";
    EXPECT_TRUE(at(0, 0).met) << "on a vertex";
    EXPECT_FALSE(at(0.5f, 0x1.000002p-1f).met) << "one ulp outside the edge";
    EXPECT_FALSE(at(0.25f, 0.25f, -1).met) << "before the origin";
    EXPECT_FALSE(cross_exactly({0.25f, -1, 0}, {0, 1, 0}, a, b, c).met) << "in the triangle's plane";
}

TEST(Exact, distances_compare_with_more_than_double)
{
    const Float3 near[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Float3 far[3] = {{0, 0, -0x1p-40f}, {1, 0, 0}, {0, 1, 0}}; // differs by a grid step at one corner
    const Float3 origin{0x1p-10f, 0x1p-10f, 1}, down{0, 0, -1};
    EXPECT_EQ(compare_distance(origin, down, near, far), std::strong_ordering::less);
    EXPECT_EQ(compare_distance(origin, down, far, near), std::strong_ordering::greater);
    EXPECT_EQ(compare_distance(origin, down, near, near), std::strong_ordering::equal);
}
