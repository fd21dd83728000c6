#pragma once

#include "bench/output/row_fields.h"

#include <fmt/format.h>

/// What lists of fields are written with.
namespace tetrace::field_parts {

inline constexpr bool required = true, optional = false;

inline Recorded recorded(const char* schema, bool always = optional, const char* what = nullptr)
{
    return {schema, always, what};
}

/// The field's column in one table.
struct ColumnOf {
    Place place;

    PlacedColumn operator()(const Shown& shown) const { return {place, shown}; }
    PlacedColumn operator()(const char* title, const char* unit = "", int decimals = 2,
                            Cell (*cell)(const nlohmann::json&) = plain_cell) const
    {
        return {place, {title, unit, decimals, cell}};
    }
};
inline constexpr ColumnOf csv{&RowField::csv}, check{&RowField::check}, rates{&RowField::rates},
    times{&RowField::times}, report{&RowField::report};

inline Cell milliseconds(const nlohmann::json& value)
{
    return value.is_null() ? Cell() : Cell(1e3 * value.get<double>());
}

inline Cell megabytes(const nlohmann::json& value)
{
    return value.is_null() ? Cell() : Cell(1e-6 * value.get<double>());
}

template <int decimals>
Cell percent(const nlohmann::json& value)
{
    return value.is_null() ? Cell()
                           : Cell(fmt::format("{:{}.{}f} %", 100 * value.get<double>(), 3 + decimals, decimals));
}

} // namespace tetrace::field_parts
