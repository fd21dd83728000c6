#include "bench/reproduce/kept_costs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* entry_key = "yardstick";

json entry_of(const std::string& device, const Yardstick& yardstick)
{
    json copies = json::array(); // pairs of bytes and rate
    for (const CopyRate& copy : yardstick.copies)
        copies.push_back({copy.bytes, copy.bytes_per_s});
    return {{entry_key, device},
            {"copy_bytes_per_s", yardstick.copy_bytes_per_s},
            {"launch_s", yardstick.launch_s},
            {"copies", std::move(copies)}};
}

bool is_positive(const json& entry, const char* key)
{
    return entry.contains(key) && entry[key].is_number() && std::isfinite(entry[key].get<double>()) && entry[key] > 0;
}

bool is_copy(const json& copy)
{
    return copy.is_array() && copy.size() == 2 && copy[0].is_number_unsigned() && copy[1].is_number() &&
           std::isfinite(copy[1].get<double>()) && copy[1] >= 0;
}

bool is_whole_entry(const json& entry)
{
    if (!entry[entry_key].is_string() || !is_positive(entry, "copy_bytes_per_s") || !is_positive(entry, "launch_s"))
        return false;
    const auto copies = entry.find("copies");
    return copies != entry.end() && copies->is_array() && copies->size() == Yardstick{}.copies.size() &&
           std::ranges::all_of(*copies, is_copy);
}

Yardstick yardstick_of(const json& entry)
{
    Yardstick yardstick{entry["copy_bytes_per_s"], entry["launch_s"]};
    std::ranges::transform(entry["copies"], yardstick.copies.begin(), [](const json& copy) {
        return CopyRate{copy[0], copy[1]};
    });
    return yardstick;
}

std::string device_key(const RowDevice& device)
{
    return fmt::format("{}:{}", device.backend, device.index);
}

} // namespace

Yardsticks::Yardsticks(Journal* journal) : journal_(journal)
{
    if (journal == nullptr) return;
    for (const json& entry : journal->entries()) {
        if (!entry.contains(entry_key)) continue;
        if (!is_whole_entry(entry)) journal->reject("a microbenchmark in the journal is damaged");
        known_[entry[entry_key]] = yardstick_of(entry);
    }
}

void Yardsticks::measure(std::vector<RowDevice>& devices, const SessionOptions& options)
{
    for (RowDevice& device : devices)
        if (const auto found = known_.find(device_key(device)); found != known_.end()) device.yardstick = found->second;
    measure_devices(devices, options);
    for (const RowDevice& device : devices) {
        if (!device.yardstick) continue;
        const bool is_new = known_.emplace(device_key(device), *device.yardstick).second;
        if (is_new && journal_ != nullptr) journal_->append(entry_of(device_key(device), *device.yardstick));
    }
}

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
