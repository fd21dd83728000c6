#include "bench/statistics/rank_interval.h"

#include "bench/statistics/statistics.h"
#include "core/base/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace tetrace {

namespace {

constexpr std::size_t max_counted = 50; // samples; counting takes n * m * n * m / 2 steps

/// The lower half of the distribution of U, the number of pairs in which the one set has the larger value, if both sets
/// are drawn from one distribution: P(U = u) for u up to n * m / 2, by the recursion of Mann and Whitney.
std::vector<double> pair_count_distribution(std::size_t n, std::size_t m)
{
    const std::size_t size = n * m / 2 + 1;
    std::vector<std::vector<double>> of(m + 1, std::vector<double>(size, 0)); // for i and j samples: of[j][u]
    for (auto& probabilities : of)
        probabilities[0] = 1;
    for (std::size_t i = 1; i <= n; ++i)
        for (std::size_t j = 1; j <= m; ++j)
            for (std::size_t u = size; u-- > 0;) { // downwards: of[j][u - j] still is that of i - 1 samples
                const double max_is_ours = u >= j ? of[j][u - j] : 0;
                of[j][u] = (static_cast<double>(i) * max_is_ours + static_cast<double>(j) * of[j - 1][u]) /
                           static_cast<double>(i + j);
            }
    return of[m];
}

/// The number of values u = 0, 1, ... whose probabilities add up to no more than `tail`.
std::size_t counted_values(std::size_t n, std::size_t m, double tail)
{
    std::size_t values = 0;
    double sum = 0;
    for (const double probability : pair_count_distribution(n, m)) {
        sum += probability;
        if (sum > tail) break;
        ++values;
    }
    return values;
}

/// The same from the normal distribution of equal mean and variance, whose tails are the heavier ones.
std::size_t approximate_values(std::size_t n, std::size_t m, double tail)
{
    const auto pairs = static_cast<double>(n) * static_cast<double>(m);
    const double deviation = std::sqrt(pairs * static_cast<double>(n + m + 1) / 12);
    const auto is_in_tail = [&](std::size_t u) {
        const double deviations = (static_cast<double>(u) + 0.5 - pairs / 2) / deviation;
        return std::erfc(-deviations / std::sqrt(2.0)) / 2 <= tail;
    };
    std::size_t inside = 0, outside = n * m / 2 + 1; // the first value that is not in the tail is between
    while (inside < outside) {
        const std::size_t middle = (inside + outside) / 2;
        (is_in_tail(middle) ? inside : outside) = is_in_tail(middle) ? middle + 1 : middle;
    }
    return inside;
}

/// How many quotients are at most x. Both sets ascend.
std::size_t quotients_up_to(double x, const std::vector<double>& numerator, const std::vector<double>& denominator)
{
    std::size_t count = 0;
    for (const double above : numerator) {
        const auto first = std::partition_point(denominator.begin(), denominator.end(),
                                                [&](double below) { return above / below > x; });
        count += static_cast<std::size_t>(denominator.end() - first);
    }
    return count;
}

/// The quotient that `rank` others precede. There may be 10^8 of them: bisected, not sorted. The bits of positive
/// numbers ascend as the numbers do.
double quotient_of_rank(std::size_t rank, const std::vector<double>& numerator, const std::vector<double>& denominator)
{
    std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (quotients_up_to(std::bit_cast<double>(middle), numerator, denominator) > rank)
            high = middle;
        else
            low = middle + 1;
    }
    return std::bit_cast<double>(low);
}

} // namespace

double min_error(std::size_t n, std::size_t m)
{
    const auto log_factorial = [](std::size_t k) { return std::lgamma(static_cast<double>(k) + 1); };
    const double log_share = log_factorial(n) + log_factorial(m) - log_factorial(n + m);
    constexpr double rounding = 1 + 1e-9;
    return std::min(1.0, 2 * std::exp(log_share) * rounding);
}

std::optional<std::size_t> quotients_left_out(std::size_t n, std::size_t m, double error)
{
    const bool few = n <= max_counted && m <= max_counted;
    const std::size_t values = few ? counted_values(n, m, error / 2) : approximate_values(n, m, error / 2);
    if (values == 0) return std::nullopt;
    return values - 1;
}

std::optional<FactorInterval> rank_interval(std::vector<double> numerator, std::vector<double> denominator,
                                            double error)
{
    const auto left_out = quotients_left_out(numerator.size(), denominator.size(), error);
    if (!left_out) return std::nullopt;
    std::ranges::sort(numerator);
    std::ranges::sort(denominator);
    const std::size_t last = numerator.size() * denominator.size() - 1;
    return FactorInterval{quotient_of_rank(*left_out, numerator, denominator),
                          quotient_of_rank(last - *left_out, numerator, denominator)};
}

namespace {

constexpr int resamples = 2000;
constexpr std::uint64_t seed = 0x7e77ace;

/// Adds as many samples drawn with replacement. The standard's distributions draw differently in each library.
void draw(const std::vector<double>& samples, std::mt19937_64& random, std::vector<double>& drawn)
{
    for (std::size_t i = 0; i < samples.size(); ++i)
        drawn.push_back(samples[random() % samples.size()]);
}

double resampled_median(const std::vector<double>& samples, std::mt19937_64& random)
{
    std::vector<double> drawn;
    draw(samples, random, drawn);
    return quantile(std::move(drawn), 0.5);
}

using Runs = std::vector<std::vector<double>>;

std::vector<double> all_of(const Runs& runs)
{
    std::vector<double> all;
    for (const auto& run : runs)
        all.insert(all.end(), run.begin(), run.end());
    return all;
}

/// Of runs and their samples, both drawn with replacement. A run is drawn for both: they shared its conditions.
double resampled_ratio(const Runs& numerator, const Runs& denominator, std::mt19937_64& random)
{
    std::vector<double> above, below;
    for (std::size_t i = 0; i < numerator.size(); ++i) {
        const std::size_t run = random() % numerator.size();
        draw(numerator[run], random, above);
        draw(denominator[run], random, below);
    }
    return quantile(std::move(above), 0.5) / quantile(std::move(below), 0.5);
}

constexpr double outside_low = (1 - ratio_confidence) / 2;

} // namespace

MedianRatio ratio_of_medians(const std::vector<double>& numerator, const std::vector<double>& denominator)
{
    const double value = statistics_of(numerator).median / statistics_of(denominator).median;
    std::mt19937_64 random(seed);
    std::vector<double> ratios;
    for (int i = 0; i < resamples; ++i) {
        const double above = resampled_median(numerator, random);
        ratios.push_back(above / resampled_median(denominator, random));
    }
    return {value, quantile(ratios, outside_low), quantile(ratios, 1 - outside_low)};
}

MedianRatio geometric_mean_of_medians(const std::vector<std::vector<double>>& lists)
{
    if (lists.empty()) throw Error(ErrorKind::internal, "the mean of no medians");
    const auto mean_of = [&](const auto& median) {
        double sum = 0;
        for (const std::vector<double>& samples : lists)
            sum += std::log(median(samples));
        return std::exp(sum / static_cast<double>(lists.size()));
    };
    const double value = mean_of([](const auto& samples) { return statistics_of(samples).median; });
    std::mt19937_64 random(seed);
    std::vector<double> means;
    for (int i = 0; i < resamples; ++i)
        means.push_back(mean_of([&](const auto& samples) { return resampled_median(samples, random); }));
    return {value, quantile(means, outside_low), quantile(means, 1 - outside_low)};
}

MedianRatio ratio_over_runs(const Runs& numerator, const Runs& denominator)
{
    if (numerator.empty() || numerator.size() != denominator.size())
        throw Error(ErrorKind::internal, "a ratio over runs of which two rows have different numbers, or none");
    std::vector<double> ratios;
    for (std::size_t run = 0; run < numerator.size(); ++run)
        ratios.push_back(statistics_of(numerator[run]).median / statistics_of(denominator[run]).median);
    const double value = statistics_of(all_of(numerator)).median / statistics_of(all_of(denominator)).median;
    if (ratios.size() < resampled_runs) {
        const auto [low, high] = std::ranges::minmax(ratios);
        return {value, std::min(value, low), std::max(value, high)};
    }
    std::mt19937_64 random(seed);
    std::vector<double> resampled;
    for (int i = 0; i < resamples; ++i)
        resampled.push_back(resampled_ratio(numerator, denominator, random));
    return {value, quantile(resampled, outside_low), quantile(resampled, 1 - outside_low)};
}

} // namespace tetrace
