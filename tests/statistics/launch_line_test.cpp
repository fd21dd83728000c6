// What a launch costs, from the same work in few launches and in many.
#include "bench/statistics/launch_line.h"

#include "core/base/error.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

/// n samples around a median of the given seconds, the outermost one in a thousand of it away.
std::vector<double> around(double seconds, int n)
{
    std::vector<double> samples;
    for (int i = 0; i < n; ++i)
        samples.push_back(seconds * (1 + 1e-3 * (2.0 * i / (n - 1) - 1)));
    return samples;
}

} // namespace

TEST(LaunchLine, goes_through_both_sizes)
{
    // 30 us of each launch and 50 us of a million rays: 4 million in a launch, or in 4.
    const LaunchLine line = launch_line({1, around(230e-6, 11)}, {4, around(320e-6, 5)}, 4);
    ASSERT_TRUE(line.fixed_s.has_value());
    EXPECT_NEAR(*line.fixed_s, 30e-6, 1e-12);
    EXPECT_NEAR(line.s_per_unit, 50e-6, 1e-12);
}

TEST(LaunchLine, knows_that_joined_launches_are_several_where_memory_is_short)
{
    const LaunchLine line = launch_line({2, around(260e-6, 11)}, {8, around(440e-6, 5)}, 4);
    ASSERT_TRUE(line.fixed_s.has_value());
    EXPECT_NEAR(*line.fixed_s, 30e-6, 1e-12);
    EXPECT_NEAR(line.s_per_unit, 50e-6, 1e-12);
}

TEST(LaunchLine, has_no_fixed_cost_that_noise_explains)
{
    for (const double single_s : {0.99, 0.9999, 1.0, 1.0001}) {
        const LaunchLine line = launch_line({1, around(1, 11)}, {4, around(single_s, 5)}, 4);
        EXPECT_FALSE(line.fixed_s.has_value()) << single_s << ": left out, and not 0";
        EXPECT_DOUBLE_EQ(line.s_per_unit, 0.25);
    }
    EXPECT_TRUE(launch_line({1, around(1, 11)}, {4, around(1.01, 5)}, 4).fixed_s.has_value());
}

TEST(LaunchLine, needs_samples_enough_and_two_sizes)
{
    EXPECT_FALSE(launch_line({1, around(1, 11)}, {4, {2}}, 4).fixed_s.has_value())
        << "one sample does not give an interval";
    EXPECT_FALSE(launch_line({4, around(1, 11)}, {4, around(2, 11)}, 4).fixed_s.has_value());
    EXPECT_FALSE(launch_line({1, around(1, 11)}, {4, around(4.5, 11)}, 4).fixed_s.has_value())
        << "more than all the work";
    EXPECT_THROW((void)launch_line({1, {}}, {4, {1}}, 4), Error);
}
