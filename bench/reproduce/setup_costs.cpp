#include "bench/reproduce/setup_costs.h"

#include <cmath>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* cost_key = "setup";

json cost_entry(const std::string& row, const SetupCost& cost)
{
    return {{cost_key, row}, {"build_s", cost.build_s}, {"pack_s", cost.pack_s}, {"bytes", cost.bytes}};
}

bool is_duration(const json& entry, const char* key)
{
    return entry.contains(key) && entry[key].is_number() && std::isfinite(entry[key].get<double>()) && entry[key] >= 0;
}

bool is_whole_cost(const json& entry)
{
    return entry[cost_key].is_string() && is_duration(entry, "build_s") && is_duration(entry, "pack_s") &&
           entry.contains("bytes") && entry["bytes"].is_number_unsigned();
}

} // namespace

SetupCosts::SetupCosts(Journal* journal) : journal_(journal)
{
    if (journal == nullptr) return;
    for (const json& entry : journal->entries()) {
        if (!entry.contains(cost_key)) continue;
        if (!is_whole_cost(entry)) journal->reject("a build time in the journal is damaged");
        known_[entry[cost_key]] = {entry["build_s"], entry["pack_s"], entry["bytes"]};
    }
}

void SetupCosts::restore(std::vector<RowRun>& rows)
{
    for (RowRun& row : rows) {
        const auto cost = setup_cost(row);
        if (!cost) continue;
        const auto [place, is_new] = known_.emplace(row_name(row.key), *cost);
        if (is_new && journal_ != nullptr) journal_->append(cost_entry(place->first, *cost));
        set_setup_cost(row, place->second);
    }
}

} // namespace tetrace
