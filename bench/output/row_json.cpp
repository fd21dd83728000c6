#include "bench/output/row_json.h"

namespace tetrace {

nlohmann::json row_json(const RowFacts& facts)
{
    nlohmann::json object;
    for (const RowField& field : row_fields()) {
        if (field.schema == nullptr || field.group == std::string_view(ratio_group)) continue;
        const bool is_grouped = *field.group != '\0';
        if (is_grouped && traced(*facts.row) == nullptr) continue; // all groups describe an answer
        nlohmann::json value = field.value(facts);
        if (!value.is_null()) (is_grouped ? object[field.group] : object)[field.key] = std::move(value);
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
