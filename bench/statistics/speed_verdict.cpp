#include "bench/statistics/speed_verdict.h"

#include "bench/statistics/statistics.h"

#include <algorithm>

namespace tetrace {

namespace {

SpeedVerdict judge(const FactorInterval& interval, double tolerance)
{
    if (interval.low >= 1 / (1 + tolerance) && interval.high <= 1 + tolerance) return SpeedVerdict::same;
    if (interval.low > 1) return SpeedVerdict::faster;
    if (interval.high < 1) return SpeedVerdict::slower;
    return SpeedVerdict::unsure;
}

} // namespace

SpeedChange compare_speed(const std::vector<double>& before_s, const std::vector<double>& after_s, std::size_t rows,
                          double tolerance)
{
    SpeedChange change;
    change.ratio = statistics_of(before_s).median / statistics_of(after_s).median;
    if (std::min(before_s.size(), after_s.size()) < min_samples) return change;
    const double smallest = min_error(before_s.size(), after_s.size());
    const double error = std::max(smallest, comparison_error / static_cast<double>(rows));
    change.interval = rank_interval(before_s, after_s, error);
    if (!change.interval) return change;
    change.error = error;
    change.interval->low = std::min(change.interval->low, change.ratio);
    change.interval->high = std::max(change.interval->high, change.ratio);
    change.verdict = judge(*change.interval, tolerance);
    return change;
}

std::size_t samples_needed(std::size_t rows)
{
    std::size_t samples = 1;
    while (min_error(samples, samples) > comparison_error / static_cast<double>(rows))
        ++samples;
    return samples;
}

} // namespace tetrace
