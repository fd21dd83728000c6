#include "bench/measuring/measure.h"
#include "bench/statistics/statistics.h"
#include "core/base/error.h"

#include <gtest/gtest.h>
#include <limits>

using namespace tetrace;

// Expected values: numpy.quantile([...], [0.25, 0.5, 0.75]), whose default is the definition used.
TEST(Statistics, quartiles_follow_the_stated_definition)
{
    const Statistics even = statistics_of({7, 15, 36, 39, 40, 41});
    EXPECT_DOUBLE_EQ(even.lower_quartile, 20.25);
    EXPECT_DOUBLE_EQ(even.median, 37.5);
    EXPECT_DOUBLE_EQ(even.upper_quartile, 39.75);
    const Statistics odd = statistics_of({4, 1, 3, 2, 5});
    EXPECT_DOUBLE_EQ(odd.lower_quartile, 2);
    EXPECT_DOUBLE_EQ(odd.median, 3);
    EXPECT_DOUBLE_EQ(odd.upper_quartile, 4);
}

TEST(Statistics, one_sample_is_its_own_median_without_spread)
{
    const Statistics one = statistics_of({2.5});
    EXPECT_DOUBLE_EQ(one.median, 2.5);
    EXPECT_DOUBLE_EQ(one.spread(), 0);
    EXPECT_FALSE(one.noisy());
}

TEST(Statistics, a_spread_above_five_percent_is_noisy)
{
    EXPECT_FALSE(statistics_of({1.0, 1.0, 1.0, 1.04, 1.04}).noisy());
    EXPECT_TRUE(statistics_of({1.0, 1.0, 1.0, 1.06, 1.06}).noisy());
}

TEST(Statistics, one_slow_sample_does_not_make_a_row_noisy)
{
    EXPECT_FALSE(statistics_of({1, 1, 1, 1, 1, 1, 1, 1, 1, 50}).noisy());
}

TEST(Statistics, samples_that_cannot_be_times_are_rejected)
{
    EXPECT_THROW(static_cast<void>(statistics_of({})), Error);
    EXPECT_THROW(static_cast<void>(statistics_of({1, 0})), Error);
    EXPECT_THROW(static_cast<void>(statistics_of({1, -1})), Error);
    EXPECT_THROW(static_cast<void>(statistics_of({1, std::numeric_limits<double>::infinity()})), Error);
}

TEST(AffordableSamples, keeps_what_fits_and_never_goes_below_five)
{
    EXPECT_EQ(affordable_samples(10, 1.0, 25), 10u);
    EXPECT_EQ(affordable_samples(10, 2.5, 25), 10u);
    EXPECT_EQ(affordable_samples(10, 5.0, 25), 5u);
    EXPECT_EQ(affordable_samples(10, 100.0, 25), 5u);
    EXPECT_EQ(affordable_samples(10, 1e12, 25), 5u);
    EXPECT_EQ(affordable_samples(3, 100.0, 25), 3u) << "asked for";
    EXPECT_EQ(affordable_samples(10, 0.0, 25), 10u);
}
