#include "bench/rivals/pay_off.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/setup_costs.h"
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

std::optional<TotalCost> total_cost(const RowRun& row)
{
    const auto cost = setup_cost(row);
    if (!cost) return std::nullopt;
    return TotalCost{cost->once_s(), 1e-6 / figures_of(row)->mrays_per_s};
}

std::optional<double> rays_until_paid(const RowRun& walk, const RowRun& other)
{
    const auto ours = total_cost(walk), others = total_cost(other);
    if (!ours || !others) return std::nullopt;
    const BreakEven even = break_even(*ours, *others);
    return even.ahead == BreakEven::Ahead::first ? even.rays.value_or(0) : never;
}

std::optional<Estimate> tracing_until_paid(const RowRun& walk, const RowRun& other)
{
    const auto ours = total_cost(walk), others = total_cost(other);
    if (!ours || !others) return std::nullopt;
    const double more_s = ours->once_s - others->once_s;
    const Estimate ratio = rate_ratio(walk, other);
    Estimate seconds{seconds_until_paid(more_s, ratio.value), {}, {}};
    if (ratio.low && ratio.high) {
        seconds.low = seconds_until_paid(more_s, *ratio.high);
        seconds.high = seconds_until_paid(more_s, *ratio.low);
    }
    return seconds;
}

} // namespace tetrace
