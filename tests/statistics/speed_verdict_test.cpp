#include "bench/statistics/speed_verdict.h"

#include "core/base/error.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

using namespace tetrace;

namespace {

using Samples = std::vector<double>;
using Random = std::mt19937_64;

/// Draws one time eleven_around a second.
using Noise = std::function<double(Random&)>;

Noise normal(double relative)
{
    return [=](Random& random) { return std::exp(std::normal_distribution<double>(0, relative)(random)); };
}

double with_delays(Random& random)
{
    return 1 + std::normal_distribution<double>(0, 0.01)(random) + std::exponential_distribution<double>(100)(random);
}

double with_heavy_tails(Random& random)
{
    return std::exp(0.01 * std::student_t_distribution<double>(3)(random));
}

double with_two_humps(Random& random)
{
    return (random() % 2 == 0 ? 1 : 1.08) * normal(0.005)(random);
}

double in_ticks(Random& random)
{
    return std::round(100 * normal(0.01)(random)) / 100;
}

Samples drawn(std::size_t count, const Noise& noise, double seconds, Random& random)
{
    Samples samples(count);
    for (double& sample : samples)
        sample = seconds * noise(random);
    return samples;
}

bool is_told_apart(const SpeedChange& change)
{
    return change.verdict == SpeedVerdict::faster || change.verdict == SpeedVerdict::slower;
}

/// How many of some comparisons of a row, one of `rows`, find a change by the factor.
int found(int trials, std::size_t samples, const Noise& noise, double factor, std::size_t rows, Random& random)
{
    int count = 0;
    for (int i = 0; i < trials; ++i)
        count += is_told_apart(
            compare_speed(drawn(samples, noise, 1, random), drawn(samples, noise, factor, random), rows, 0.0));
    return count;
}

SpeedVerdict verdict_of(const Samples& before, const Samples& after, double tolerance)
{
    return compare_speed(before, after, 1, tolerance).verdict;
}

Samples eleven_around(double seconds, double relative)
{
    Samples samples;
    for (int i = -5; i <= 5; ++i)
        samples.push_back(seconds * (1 + relative * i / 5));
    return samples;
}

} // namespace

// 1 % is promised; the standard deviation of 2,000 trials at 1 % is 0.22 %, so 1.7 % is three of them above.
TEST(SpeedVerdict, raises_false_alarms_in_fewer_than_one_of_a_hundred_comparisons)
{
    const std::pair<const char*, Noise> noises[] = {{"normal", normal(0.02)},
                                                    {"delays", with_delays},
                                                    {"heavy tails", with_heavy_tails},
                                                    {"two humps", with_two_humps},
                                                    {"ticks", in_ticks}};
    for (const auto& [name, noise] : noises)
        for (const std::size_t samples : {5u, 10u, 20u}) {
            Random random(samples);
            EXPECT_LE(found(2000, samples, noise, 1, 1, random), 34) << name << ", " << samples << " samples";
        }
}

TEST(SpeedVerdict, finds_five_percent_through_two_percent_of_noise_in_twenty_samples)
{
    for (const std::size_t rows : {1u, 20u, 100u}) {
        Random random(rows);
        EXPECT_GE(found(200, 20, normal(0.02), 1.05, rows, random), 190) << rows << " rows";
        EXPECT_GE(found(200, 20, normal(0.02), 1 / 1.05, rows, random), 190) << rows << " rows";
    }
}

// 400 comparisons of 20 rows: 4 alarms are promised at most, 10 are three standard deviations above. Intervals of 99 %
// for each row by itself would give 73.
TEST(SpeedVerdict, keeps_its_promise_for_all_rows_of_a_comparison_together)
{
    Random random(11);
    int alarms = 0;
    for (int i = 0; i < 400; ++i)
        alarms += found(20, 10, normal(0.02), 1, 20, random) > 0;
    EXPECT_LE(alarms, 10);
}

// A true difference of 3.5 % is outside the tolerance of 3 %: the same in fewer than 1 of 200.
TEST(SpeedVerdict, hardly_ever_calls_the_same_what_differs_by_more_than_the_tolerance)
{
    Random random(12);
    int same = 0, same_within = 0;
    const auto is_same = [&](double factor) {
        const auto before = drawn(20, normal(0.01), 1, random), after = drawn(20, normal(0.01), factor, random);
        return verdict_of(before, after, 0.03) == SpeedVerdict::same;
    };
    for (int i = 0; i < 1000; ++i) {
        same += is_same(1.0305);
        same_within += is_same(1);
    }
    EXPECT_LE(same, 11);
    EXPECT_GE(same_within, 990) << "and what is equal is found to be so";
}

TEST(SpeedVerdict, is_same_within_the_tolerance_even_where_a_difference_is_certain)
{
    EXPECT_EQ(verdict_of(eleven_around(1, 0.001), eleven_around(1.01, 0.001), 0.03), SpeedVerdict::same);
    EXPECT_EQ(verdict_of(eleven_around(1, 0.001), eleven_around(1.01, 0.001), 0.005), SpeedVerdict::slower);
    EXPECT_EQ(verdict_of(eleven_around(1.01, 0.001), eleven_around(1, 0.001), 0.005), SpeedVerdict::faster);
}

TEST(SpeedVerdict, is_unsure_where_noise_hides_more_than_the_tolerance)
{
    EXPECT_EQ(verdict_of(eleven_around(1, 0.2), eleven_around(1.01, 0.2), 0.03), SpeedVerdict::unsure);
    EXPECT_EQ(verdict_of(eleven_around(1, 0.2), eleven_around(1.01, 0.2), 1), SpeedVerdict::same);
}

TEST(SpeedVerdict, ratio_is_that_of_the_medians_and_lies_in_its_interval)
{
    const SpeedChange change = compare_speed({2, 2, 2, 2, 4, 4, 4}, {1, 1, 1, 2, 2, 2, 2}, 1, 0.03);
    EXPECT_EQ(change.ratio, 1);
    // The middle of many samples with two humps is in the one or the other; few quotients are.
    Samples low(100, 1), high(100, 1);
    std::fill(low.begin(), low.begin() + 49, 1.5);
    std::fill(high.begin(), high.begin() + 52, 1.5);
    const SpeedChange humps = compare_speed(high, low, 1, 0.03);
    EXPECT_EQ(humps.ratio, 1.5);
    ASSERT_TRUE(humps.interval);
    EXPECT_TRUE(humps.interval->contains(1.5));
    EXPECT_EQ(humps.verdict, SpeedVerdict::unsure);
}

TEST(SpeedVerdict, of_fewer_than_five_samples_is_unsure)
{
    const SpeedChange change = compare_speed({1, 1, 1, 1}, {10, 10, 10, 10}, 1, 0.03);
    EXPECT_EQ(change.verdict, SpeedVerdict::unsure);
    EXPECT_FALSE(change.interval);
    EXPECT_EQ(change.ratio, 0.1);
    EXPECT_EQ(verdict_of({1, 1, 1, 1, 1}, {10, 10, 10, 10, 10}, 0.03), SpeedVerdict::slower);
}

TEST(SpeedVerdict, takes_the_smallest_error_that_few_samples_allow)
{
    const auto error = [](std::size_t samples, std::size_t rows) {
        return compare_speed(Samples(samples, 1), Samples(samples, 1), rows, 0.03).error;
    };
    EXPECT_DOUBLE_EQ(error(5, 1), 0.01);
    EXPECT_NEAR(error(5, 16), 2.0 / 252, 1e-9);
    EXPECT_DOUBLE_EQ(error(10, 16), 0.01 / 16);
    EXPECT_EQ(samples_needed(1), 5u);
    EXPECT_EQ(samples_needed(16), 7u);
    EXPECT_DOUBLE_EQ(error(samples_needed(500), 500), 0.01 / 500);
}

TEST(SpeedVerdict, is_a_regression_only_over_the_tolerance)
{
    const auto regressed = [](double seconds, double tolerance) {
        return compare_speed(eleven_around(1, 0.004), eleven_around(seconds, 0.004), 1, tolerance)
            .is_regression(tolerance);
    };
    EXPECT_TRUE(regressed(1.06, 0.05));
    EXPECT_FALSE(regressed(1.049, 0.05));
    EXPECT_FALSE(regressed(1 / 1.06, 0.05));
    EXPECT_TRUE(regressed(1.01, 0));
    EXPECT_FALSE(regressed(1, 0));
}

TEST(SpeedVerdict, of_samples_that_cannot_be_times_is_refused)
{
    EXPECT_THROW(static_cast<void>(compare_speed({}, {1}, 1, 0.03)), Error);
    EXPECT_THROW(static_cast<void>(compare_speed({1, 0}, {1, 1}, 1, 0.03)), Error);
}
