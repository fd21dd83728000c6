#include "bench/statistics/power_law.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tetrace {

namespace {

/// Student's 97.5 % quantile, by degrees of freedom from 1 on; above, that of the largest, which errs on the safe side.
double student_quantile(std::size_t degrees)
{
    static constexpr std::array<double, 20> quantiles = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646,
                                                         2.3060,  2.2622, 2.2281, 2.2010, 2.1788, 2.1604, 2.1448,
                                                         2.1314,  2.1199, 2.1098, 2.1009, 2.0930, 2.0860};
    return quantiles[std::min(degrees, quantiles.size()) - 1];
}

std::vector<double> logarithms(const std::vector<double>& values)
{
    std::vector<double> logs;
    for (const double value : values)
        logs.push_back(std::log(value));
    return logs;
}

bool all_positive(const std::vector<double>& values)
{
    return std::ranges::all_of(values, [](double value) { return value > 0 && std::isfinite(value); });
}

double standard_error(const std::vector<double>& x, const std::vector<double>& y, const Line& line)
{
    const auto n = static_cast<double>(x.size());
    double mean = 0, squares = 0, residuals = 0;
    for (const double value : x)
        mean += value / n;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off = y[i] - line.intercept - line.slope * x[i];
        squares += (x[i] - mean) * (x[i] - mean);
        residuals += off * off;
    }
    return std::sqrt(residuals / (n - 2) / squares);
}

} // namespace

std::optional<PowerLaw> fit_power_law(const std::vector<double>& x, const std::vector<double>& y)
{
    if (x.size() != y.size()) throw Error(ErrorKind::internal, "a power law through values of other points");
    if (x.size() < 3 || !all_positive(x) || !all_positive(y)) return std::nullopt;
    const auto [least, most] = std::ranges::minmax_element(x);
    if (*least == *most) return std::nullopt;
    const auto log_x = logarithms(x), log_y = logarithms(y);
    const Line line = fit_line(log_x, log_y);
    const double reach = student_quantile(x.size() - 2) * standard_error(log_x, log_y, line);
    return PowerLaw{std::exp(line.intercept), {line.slope, line.slope - reach, line.slope + reach, false}};
}

} // namespace tetrace
