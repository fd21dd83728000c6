#include "bench/statistics/rank_interval.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

using namespace tetrace;

namespace {

using Samples = std::vector<double>;

Samples drawn(std::size_t count, std::mt19937_64& random)
{
    std::lognormal_distribution<double> times(0, 0.3);
    Samples samples(count);
    for (double& sample : samples)
        sample = times(random);
    return samples;
}

Samples sorted_quotients(const Samples& numerator, const Samples& denominator)
{
    Samples quotients;
    for (const double above : numerator)
        for (const double below : denominator)
            quotients.push_back(above / below);
    std::sort(quotients.begin(), quotients.end());
    return quotients;
}

} // namespace

// Critical values of U, two-sided, from the tables in textbooks (Mann and Whitney's own, extended by Auble in 1953).
TEST(RankInterval, leaves_out_as_many_quotients_as_the_tables_of_the_test_say)
{
    const auto left_out = [](std::size_t n, std::size_t m, double error) {
        return quotients_left_out(n, m, error).value_or(9999);
    };
    EXPECT_EQ(left_out(5, 5, 0.05), 2u);
    EXPECT_EQ(left_out(5, 8, 0.05), 6u);
    EXPECT_EQ(left_out(8, 5, 0.05), 6u);
    EXPECT_EQ(left_out(10, 10, 0.05), 23u);
    EXPECT_EQ(left_out(10, 10, 0.01), 16u);
    EXPECT_EQ(left_out(20, 20, 0.05), 127u);
    EXPECT_EQ(left_out(20, 20, 0.01), 105u);
    EXPECT_EQ(left_out(5, 5, 0.01), 0u);
}

TEST(RankInterval, needs_samples_enough_for_its_error)
{
    EXPECT_FALSE(quotients_left_out(4, 4, 0.01));
    EXPECT_FALSE(quotients_left_out(5, 5, 0.0079));
    EXPECT_FALSE(quotients_left_out(0, 5, 0.01));
    EXPECT_FALSE(rank_interval({1, 1, 1}, {2, 2, 2}, 0.01));
    for (std::size_t n = 1; n < 12; ++n)
        for (std::size_t m = 1; m < 12; ++m) {
            EXPECT_EQ(quotients_left_out(n, m, min_error(n, m)), 0u) << n << " and " << m;
            EXPECT_FALSE(quotients_left_out(n, m, 0.999999 * min_error(n, m))) << n << " and " << m;
        }
    EXPECT_NEAR(min_error(5, 5), 2.0 / 252, 1e-10);
    EXPECT_NEAR(min_error(10, 10), 2.0 / 184756, 1e-12);
}

TEST(RankInterval, ends_at_quotients_of_samples)
{
    std::mt19937_64 random(3);
    for (const auto& [n, m] : {std::pair{5u, 5u}, {7u, 12u}, {20u, 20u}, {60u, 9u}}) {
        const Samples a = drawn(n, random), b = drawn(m, random), quotients = sorted_quotients(a, b);
        const std::size_t left_out = quotients_left_out(n, m, 0.01).value();
        const auto interval = rank_interval(a, b, 0.01);
        ASSERT_TRUE(interval);
        EXPECT_EQ(interval->low, quotients[left_out]);
        EXPECT_EQ(interval->high, quotients[quotients.size() - 1 - left_out]);
    }
}

TEST(RankInterval, of_the_inverse_is_the_inverse)
{
    std::mt19937_64 random(4);
    const Samples a = drawn(9, random), b = drawn(14, random);
    const auto there = rank_interval(a, b, 0.01), back = rank_interval(b, a, 0.01);
    ASSERT_TRUE(there && back);
    EXPECT_DOUBLE_EQ(there->low, 1 / back->high);
    EXPECT_DOUBLE_EQ(there->high, 1 / back->low);
}

TEST(RankInterval, is_not_moved_by_an_outlier)
{
    Samples a = {1.00, 1.01, 1.02, 1.03, 1.04, 1.05, 1.06, 1.07, 1.08, 1.09}, b = a;
    const auto before = rank_interval(a, b, 0.01);
    a.back() = 50;
    const auto after = rank_interval(a, b, 0.01);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->low, after->low);
    EXPECT_NEAR(before->high, after->high, 0.011);
}

// All orders that five to seven samples of one distribution and as many of another, equal one can come in: each is
// equally likely, whatever the distribution.
TEST(RankInterval, excludes_1_in_fewer_than_one_of_a_hundred_orders_of_equal_samples)
{
    for (const std::size_t n : {5u, 6u, 7u}) {
        std::vector<int> is_first(2 * n, 0);
        std::fill(is_first.begin() + static_cast<std::ptrdiff_t>(n), is_first.end(), 1);
        int orders = 0, alarms = 0;
        do {
            Samples sets[2];
            for (std::size_t rank = 0; rank < 2 * n; ++rank)
                sets[is_first[rank]].push_back(1 + 0.1 * static_cast<double>(rank));
            alarms += !rank_interval(sets[1], sets[0], 0.01)->contains(1);
            ++orders;
        } while (std::next_permutation(is_first.begin(), is_first.end()));
        EXPECT_LT(alarms, 0.01 * orders) << n << " samples";
        EXPECT_GE(alarms, 2) << n << " samples: all of the one are above all of the other, or below";
    }
}

// Binomial standard deviation of 2,000 trials at 1 %: 0.22 %.
TEST(RankInterval, contains_the_factor_as_often_as_it_says_where_the_normal_approximation_serves)
{
    std::mt19937_64 random(6);
    int missed = 0;
    for (int i = 0; i < 2000; ++i) {
        Samples a = drawn(60, random);
        for (double& sample : a)
            sample *= 1.7;
        missed += !rank_interval(a, drawn(55, random), 0.01)->contains(1.7);
    }
    EXPECT_LE(missed, 34);
    EXPECT_GE(missed, 6) << "far wider than need be";
}

TEST(RankInterval, grows_steadily_from_counting_to_the_approximation)
{
    const auto share = [](std::size_t n) {
        return static_cast<double>(quotients_left_out(n, n, 0.0005).value()) / static_cast<double>(n * n);
    };
    EXPECT_LT(share(49), share(50));
    EXPECT_LT(share(50), share(52));
    EXPECT_LT(share(52) - share(50), 0.01);
}

TEST(RankInterval, takes_ten_thousand_samples)
{
    std::mt19937_64 random(8);
    const auto interval = rank_interval(drawn(10000, random), drawn(10000, random), 0.01);
    ASSERT_TRUE(interval);
    EXPECT_TRUE(interval->contains(1));
    EXPECT_LT(interval->high - interval->low, 0.03);
}
