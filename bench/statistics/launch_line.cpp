#include "bench/statistics/launch_line.h"

#include "bench/statistics/rank_interval.h"
#include "bench/statistics/statistics.h"

namespace tetrace {

LaunchLine launch_line(const LaunchSamples& joined, const LaunchSamples& single, double units)
{
    constexpr double error = 0.05;
    const double joined_s = statistics_of(joined.seconds).median, single_s = statistics_of(single.seconds).median;
    LaunchLine line{std::nullopt, joined_s / units};
    const double more = single.launches - joined.launches;
    if (more <= 0) return line;
    const auto interval = rank_interval(single.seconds, joined.seconds, error);
    const double fixed_s = (single_s - joined_s) / more, work_s = joined_s - fixed_s * joined.launches;
    if (!interval || interval->low <= 1 || fixed_s <= 0 || work_s <= 0) return line;
    return {fixed_s, work_s / units};
}

} // namespace tetrace
