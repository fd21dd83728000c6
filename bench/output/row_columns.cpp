#include "bench/output/row_fields.h"

#include <fmt/format.h>

namespace tetrace {

Cell plain_cell(const nlohmann::json& value)
{
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return value.get<double>();
    if (value.is_number()) return value.get<std::uint64_t>();
    return value.is_boolean() && value.get<bool>() ? Cell("yes") : Cell();
}

std::vector<Column> columns_of(Place place, const std::string& reference)
{
    std::vector<Column> columns;
    for (const RowField& field : row_fields())
        if (const Shown& shown = field.*place; shown.title != nullptr)
            columns.push_back({shown.key != nullptr ? shown.key : field.key,
                               fmt::format(fmt::runtime(shown.title), fmt::arg("reference", reference)), shown.unit,
                               shown.decimals, std::string_view(field.key) == row_key::status.key, shown.rank});
    return columns;
}

std::vector<Cell> cells_of(Place place, const RowFacts& facts)
{
    std::vector<Cell> cells;
    for (const RowField& field : row_fields())
        if (const Shown& shown = field.*place; shown.title != nullptr) cells.push_back(shown.cell(field.value(facts)));
    return cells;
}

nlohmann::json& field_in(nlohmann::json& row, const RowPath& path)
{
    return (*path.group == '\0' ? row : row[path.group])[path.key];
}

nlohmann::json row_json(const RowFacts& facts)
{
    nlohmann::json object;
    for (const RowField& field : row_fields()) {
        if (field.schema == nullptr || field.group == std::string_view(ratio_group)) continue;
        const bool is_grouped = *field.group != '\0';
        if (is_grouped && traced(*facts.row) == nullptr) continue; // all groups describe an answer
        nlohmann::json value = field.value(facts);
        if (!value.is_null()) field_in(object, field) = std::move(value);
    }
    return object;
}

nlohmann::json ratio_json(const RowFacts& facts)
{
    nlohmann::json object;
    for (const RowField& field : row_fields())
        if (field.group == std::string_view(ratio_group))
            if (nlohmann::json value = field.value(facts); !value.is_null()) object[field.key] = std::move(value);
    return object;
}

} // namespace tetrace
