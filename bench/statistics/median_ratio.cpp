#include "bench/statistics/median_ratio.h"

#include "bench/statistics/statistics.h"
#include "core/base/error.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace tetrace {

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
