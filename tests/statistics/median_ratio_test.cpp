#include "bench/statistics/rank_interval.h"

#include "core/base/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace tetrace;

namespace {

using Samples = std::vector<double>;

/// Seconds of a program on a machine that is now and then slower, never faster: 1 % of noise either way, and delays.
Samples times_with_delays(int count, double seconds, std::mt19937_64& random)
{
    std::normal_distribution<double> noise(0, 0.01);
    std::exponential_distribution<double> delay(100);
    Samples samples;
    for (int i = 0; i < count; ++i)
        samples.push_back(seconds * (1 + noise(random) + delay(random)));
    return samples;
}

Samples normal_times(int count, double seconds, double relative_noise, std::mt19937_64& random)
{
    std::normal_distribution<double> noise(0, relative_noise);
    Samples samples;
    for (int i = 0; i < count; ++i)
        samples.push_back(seconds * std::exp(noise(random)));
    return samples;
}

/// Share of 400 simulated comparisons whose interval contains the true ratio.
double coverage(int count)
{
    constexpr int trials = 400;
    std::mt19937_64 random(static_cast<std::uint64_t>(count));
    int covered = 0;
    for (int i = 0; i < trials; ++i)
        covered +=
            ratio_of_medians(times_with_delays(count, 3, random), times_with_delays(count, 2, random)).contains(1.5);
    return static_cast<double>(covered) / trials;
}

} // namespace

TEST(MedianRatio, is_the_quotient_of_the_medians)
{
    EXPECT_DOUBLE_EQ(ratio_of_medians({3, 1, 2}, {4, 5, 3}).value, 0.5);
}

TEST(MedianRatio, samples_without_spread_leave_no_doubt)
{
    const MedianRatio ratio = ratio_of_medians({3, 3, 3, 3}, {2, 2, 2, 2});
    EXPECT_DOUBLE_EQ(ratio.low, 1.5);
    EXPECT_DOUBLE_EQ(ratio.high, 1.5);
}

TEST(MedianRatio, equal_samples_give_equal_intervals)
{
    const Samples a = {1, 1.2, 0.9, 1.1, 1.05, 0.97}, b = {2, 2.1, 1.9, 2.05, 2.2, 1.95};
    const MedianRatio first = ratio_of_medians(a, b), second = ratio_of_medians(a, b);
    EXPECT_EQ(first.low, second.low);
    EXPECT_EQ(first.high, second.high);
    EXPECT_LT(first.low, first.value);
    EXPECT_GT(first.high, first.value);
}

// Binomial standard deviation of 400 trials at 95 %: 1.1 %. Intervals of medians are known to be a little too wide.
TEST(MedianRatio, the_interval_contains_the_true_ratio_as_often_as_it_says)
{
    for (const int count : {6, 10, 20, 41}) {
        EXPECT_GE(coverage(count), 0.92) << count << " samples";
        EXPECT_LE(coverage(count), 0.995) << count << " samples";
    }
}

TEST(MedianRatio, two_runs_of_one_program_are_hardly_ever_distinguished)
{
    std::mt19937_64 random(5);
    int equal = 0;
    for (int i = 0; i < 200; ++i)
        equal += ratio_of_medians(normal_times(20, 1, 0.02, random), normal_times(20, 1, 0.02, random)).contains(1);
    EXPECT_GE(equal, 184);
}

TEST(MedianRatio, five_percent_are_seen_through_two_percent_of_noise_in_twenty_samples)
{
    std::mt19937_64 random(7);
    int seen = 0;
    for (int i = 0; i < 200; ++i)
        seen += !ratio_of_medians(normal_times(20, 1.05, 0.02, random), normal_times(20, 1, 0.02, random)).contains(1);
    EXPECT_GE(seen, 190);
}

TEST(MedianRatio, samples_that_cannot_be_times_are_rejected)
{
    EXPECT_THROW(static_cast<void>(ratio_of_medians({}, {1})), Error);
    EXPECT_THROW(static_cast<void>(ratio_of_medians({1}, {0})), Error);
}

namespace {

/// Runs of both rows, whose true ratio is 1: each run makes one row faster or slower by its own factor, of some spread.
std::pair<std::vector<Samples>, std::vector<Samples>> runs_of(std::size_t runs, double spread, std::mt19937_64& random)
{
    std::pair<std::vector<Samples>, std::vector<Samples>> found;
    for (std::size_t run = 0; run < runs; ++run) {
        found.first.push_back(normal_times(10, normal_times(1, 1, spread, random).front(), 0.005, random));
        found.second.push_back(normal_times(10, 1, 0.005, random));
    }
    return found;
}

} // namespace

TEST(RatioOverRuns, of_few_runs_has_their_range)
{
    const std::vector<Samples> a = {{1, 1, 1}, {1.2, 1.2, 1.2}, {1.1, 1.1, 1.1}}, b = {{2, 2, 2}, {2, 2, 2}, {2, 2, 2}};
    const MedianRatio ratio = ratio_over_runs(a, b);
    EXPECT_DOUBLE_EQ(ratio.value, 0.55) << "of the medians of all samples";
    EXPECT_DOUBLE_EQ(ratio.low, 0.5);
    EXPECT_DOUBLE_EQ(ratio.high, 0.6);
}

TEST(RatioOverRuns, compares_runs_that_shared_their_conditions)
{
    const std::vector<Samples> a = {{1, 1, 1}, {3, 3, 3}, {2, 2, 2}}, b = {{2, 2, 2}, {6, 6, 6}, {4, 4, 4}};
    const MedianRatio ratio = ratio_over_runs(a, b);
    EXPECT_DOUBLE_EQ(ratio.low, 0.5) << "slow runs are slow for both";
    EXPECT_DOUBLE_EQ(ratio.high, 0.5);
}

// Runs differ by 5 %, their samples by 0.5 %: what one run calls certain, the next contradicts.
TEST(RatioOverRuns, contains_the_truth_where_the_interval_of_one_run_does_not)
{
    std::mt19937_64 random(11);
    constexpr int trials = 200;
    int of_samples = 0, of_runs = 0;
    for (int i = 0; i < trials; ++i) {
        const auto [a, b] = runs_of(10, 0.05, random);
        of_samples += ratio_of_medians(a[0], b[0]).contains(1);
        of_runs += ratio_over_runs(a, b).contains(1);
    }
    EXPECT_LT(of_samples, trials / 4);
    EXPECT_GT(of_runs, trials * 8 / 10);
}

TEST(RatioOverRuns, rejects_runs_that_do_not_belong_together)
{
    EXPECT_THROW(static_cast<void>(ratio_over_runs({}, {})), Error);
    EXPECT_THROW(static_cast<void>(ratio_over_runs({{1}, {1}}, {{1}})), Error);
    EXPECT_THROW(static_cast<void>(ratio_over_runs({{1}, {0}}, {{1}, {1}})), Error);
}
