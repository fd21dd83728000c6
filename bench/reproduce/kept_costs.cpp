#include "bench/reproduce/kept_costs.h"

#include "bench/rows/json_numbers.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char *yardstick_key = "yardstick", *cost_key = "setup";

/// The entries of the journal that have the key, whose value names them. what: they are, in words.
template <class Value>
std::map<std::string, Value> kept_values(const Journal* journal, const char* key, const char* what,
                                         Value (*read)(const json&))
{
    std::map<std::string, Value> values;
    if (journal == nullptr) return values;
    const auto reject = [&] { journal->reject(fmt::format("{} in the journal is damaged", what)); };
    for (const json& entry : journal->entries()) {
        if (!entry.contains(key)) continue;
        try {
            values[entry[key].get<std::string>()] = read(entry);
        } catch (const json::exception&) {
            reject();
        } catch (const std::logic_error&) {
            reject();
        }
    }
    return values;
}

json entry_of(const std::string& device, const Yardstick& yardstick)
{
    json copies = json::array(); // pairs of bytes and rate
    for (const CopyRate& copy : yardstick.copies)
        copies.push_back({copy.bytes, copy.bytes_per_s});
    return {{yardstick_key, device},
            {"copy_bytes_per_s", yardstick.copy_bytes_per_s},
            {"launch_s", yardstick.launch_s},
            {"copies", std::move(copies)}};
}

Yardstick yardstick_from(const json& entry)
{
    Yardstick yardstick{amount_from(entry.at("copy_bytes_per_s")), amount_from(entry.at("launch_s"))};
    const json& copies = entry.at("copies");
    if (yardstick.copy_bytes_per_s == 0 || yardstick.launch_s == 0 || copies.size() != yardstick.copies.size())
        throw std::domain_error("not measured");
    std::ranges::transform(copies, yardstick.copies.begin(), [](const json& copy) {
        return CopyRate{count_from<std::uint64_t>(copy.at(0)), amount_from(copy.at(1))};
    });
    return yardstick;
}

json entry_of(const std::string& row, const SetupCost& cost)
{
    return {{cost_key, row}, {"build_s", cost.build_s}, {"pack_s", cost.pack_s}, {"bytes", cost.bytes}};
}

SetupCost cost_from(const json& entry)
{
    return {amount_from(entry.at("build_s")), amount_from(entry.at("pack_s")),
            count_from<std::uint64_t>(entry.at("bytes"))};
}

std::string device_key(const RowDevice& device)
{
    return fmt::format("{}:{}", device.backend, device.index);
}

} // namespace

Yardsticks::Yardsticks(Journal* journal)
    : journal_(journal), known_(kept_values(journal, yardstick_key, "a microbenchmark", yardstick_from))
{
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

SetupCosts::SetupCosts(Journal* journal)
    : journal_(journal), known_(kept_values(journal, cost_key, "a build time", cost_from))
{
}

void SetupCosts::restore(std::vector<RowRun>& rows)
{
    for (RowRun& row : rows) {
        const auto cost = setup_cost(row);
        if (!cost) continue;
        const auto [place, is_new] = known_.emplace(row_name(row.key), *cost);
        if (is_new && journal_ != nullptr) journal_->append(entry_of(place->first, *cost));
        set_setup_cost(row, place->second);
    }
}

} // namespace tetrace
