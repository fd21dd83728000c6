#include "bench/statistics/median_ratio.h"

#include "bench/statistics/statistics.h"

#include <cstdint>
#include <random>

namespace tetrace {

namespace {

constexpr int resamples = 2000;
constexpr std::uint64_t seed = 0x7e77ace;

/// The median of as many samples drawn with replacement. The standard's distributions draw differently in each library.
double resampled_median(const std::vector<double>& samples, std::mt19937_64& random)
{
    std::vector<double> drawn(samples.size());
    for (double& sample : drawn)
        sample = samples[random() % samples.size()];
    return quantile(std::move(drawn), 0.5);
}

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
    constexpr double tail = (1 - ratio_confidence) / 2;
    return {value, quantile(ratios, tail), quantile(ratios, 1 - tail)};
}

} // namespace tetrace
