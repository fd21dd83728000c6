#pragma once

#include "bench/statistics/interval.h"

#include <optional>
#include <vector>

namespace tetrace {

/// y = factor * x^exponent.
struct PowerLaw {
    double factor = 0;
    Estimate exponent; ///< with its 95 % interval
};

/// The line of least squares through the logarithms. The exponent's interval is Student's: it assumes that the
/// residuals are independent and normal. It shows how well a power fits these points, and nothing about points outside
/// them. Empty for fewer than 3 points, for a value that is not positive and finite, or where x does not vary. Throws
/// Error{internal} for lists of different lengths.
[[nodiscard]] std::optional<PowerLaw> fit_power_law(const std::vector<double>& x, const std::vector<double>& y);

} // namespace tetrace
