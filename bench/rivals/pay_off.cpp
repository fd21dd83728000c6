#include "bench/rivals/pay_off.h"

#include "bench/rivals/contest.h"

#include <limits>

namespace tetrace {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

double seconds_until_paid(double more_s, double ratio)
{
    if (more_s <= 0 && ratio >= 1) return 0;
    return ratio > 1 ? more_s / (ratio - 1) : never;
}

std::optional<Estimate> tracing_until_paid(const RowRecord& walk, const RowRecord& other)
{
    const auto ours = setup_cost(walk), others = setup_cost(other);
    if (!ours || !others) return std::nullopt;
    const double more_s = ours->once_s() - others->once_s();
    const Estimate ratio = rate_ratio(walk, other);
    Estimate seconds{seconds_until_paid(more_s, ratio.value), {}, {}};
    if (ratio.low && ratio.high) {
        seconds.low = seconds_until_paid(more_s, *ratio.high);
        seconds.high = seconds_until_paid(more_s, *ratio.low);
    }
    return seconds;
}

} // namespace tetrace
