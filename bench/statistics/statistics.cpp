#include "bench/statistics/statistics.h"

#include "core/base/error.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

double quantile(std::vector<double> samples, double p)
{
    if (samples.empty()) throw Error(ErrorKind::internal, "quantile of no samples");
    std::ranges::sort(samples);
    const double position = p * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const auto above = std::min(below + 1, samples.size() - 1);
    return std::lerp(samples[below], samples[above], position - static_cast<double>(below));
}

Statistics statistics_of(const std::vector<double>& samples)
{
    if (std::ranges::any_of(samples, [](double s) { return !(std::isfinite(s) && s > 0); }))
        throw Error(ErrorKind::internal, "a sample that is not positive and finite");
    return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75)};
}

} // namespace tetrace
