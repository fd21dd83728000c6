#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tetrace {

// Numbers of a journal, whose lines anyone may have written. The library itself converts any number into any type, and
// of one that the type cannot hold the result is undefined. These throw std::domain_error.

template <std::unsigned_integral Count>
[[nodiscard]] Count count_from(const nlohmann::json& value)
{
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<Count>::max())
        throw std::domain_error(value.dump() + " is not a count, or too large");
    return value.get<Count>();
}

/// JSON has neither NaN nor infinity: both are null there, and are read as NaN.
[[nodiscard]] inline float float_from(const nlohmann::json& value)
{
    if (value.is_null()) return std::numeric_limits<float>::quiet_NaN();
    if (!value.is_number() || !(std::abs(value.get<double>()) <= std::numeric_limits<float>::max()))
        throw std::domain_error(value.dump() + " is not a number, or too large");
    return value.get<float>();
}

/// Seconds, or another quantity that is finite and not negative.
[[nodiscard]] inline double amount_from(const nlohmann::json& value)
{
    if (!value.is_number() || !std::isfinite(value.get<double>()) || value.get<double>() < 0)
        throw std::domain_error(value.dump() + " is not a number, negative, or too large");
    return value.get<double>();
}

} // namespace tetrace
