#include "bench/reproduce/yardsticks.h"

#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* entry_key = "yardstick";

json entry_of(const std::string& device, const Yardstick& yardstick)
{
    return {{entry_key, device}, {"copy_bytes_per_s", yardstick.copy_bytes_per_s}, {"launch_s", yardstick.launch_s}};
}

bool is_positive(const json& entry, const char* key)
{
    return entry.contains(key) && entry[key].is_number() && std::isfinite(entry[key].get<double>()) && entry[key] > 0;
}

bool is_whole_entry(const json& entry)
{
    return entry[entry_key].is_string() && is_positive(entry, "copy_bytes_per_s") && is_positive(entry, "launch_s");
}

std::string device_key(const RowDevice& device)
{
    return fmt::format("{}:{}", device.backend->name(), device.index);
}

} // namespace

Yardsticks::Yardsticks(Journal* journal) : journal_(journal)
{
    if (journal == nullptr) return;
    for (const json& entry : journal->entries()) {
        if (!entry.contains(entry_key)) continue;
        if (!is_whole_entry(entry)) journal->reject("a yardstick in the journal is damaged");
        known_[entry[entry_key]] = {entry["copy_bytes_per_s"], entry["launch_s"]};
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

} // namespace tetrace
