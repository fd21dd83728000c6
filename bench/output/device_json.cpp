#include "bench/output/device_json.h"

namespace tetrace {

namespace {

using nlohmann::json;

void set_known(json& object, const char* key, const std::string& text)
{
    if (!text.empty()) object[key] = text;
}

template <class Number>
void set_known(json& object, const char* key, Number number)
{
    if (number > 0) object[key] = number;
}

} // namespace

json device_json(const Device& device)
{
    json object = {{"name", device.name}, {"type", name_of(device.kind)}, {"driver", device.driver}, {"id", device.id}};
    set_known(object, "implementation", device.implementation);
    set_known(object, "uuid", device.uuid);
    set_known(object, "pci", device.pci);
    set_known(object, "memory_bytes", device.memory_bytes);
    set_known(object, "max_buffer_bytes", device.max_buffer_bytes);
    set_known(object, "max_group_items", device.max_group_items);
    set_known(object, "group_width", device.group_width);
    set_known(object, "timer_period_s", device.timer_period_s);
    set_known(object, "threads", device.threads);
    return object;
}

json self_test_json(const SelfTest& test)
{
    return {{"exact", test.is_exact()},
            {"contracts", test.contracts},
            {"denormals_kept", test.denormals_kept},
            {"division_ulps", test.division_ulps},
            {"square_root_ulps", test.square_root_ulps},
            {"sums_right", test.sums_right},
            {"comparisons_right", test.comparisons_right},
            {"integers_right", test.integers_right},
            {"conversions_right", test.conversions_right},
            {"bits_kept", test.bits_kept},
            {"text", test.text()}};
}

json gpu_json(const GpuReadings& readings)
{
    json object = {{"dropped_samples", readings.dropped}};
    const std::pair<const char*, std::optional<double> GpuState::*> told[] = {
        {"clock_mhz", &GpuState::clock_mhz},
        {"memory_clock_mhz", &GpuState::memory_clock_mhz},
        {"power_w", &GpuState::power_w},
        {"temperature_c", &GpuState::temperature_c}};
    for (const auto& [key, member] : told)
        if (const auto median = readings.median(member)) object[key] = *median;
    set_known(object, "throttled_samples", readings.throttled());
    set_known(object, "throttled_by", readings.reasons);
    return object;
}

json row_device_json(const RowDevice& device)
{
    json object = device_json(device.device);
    object["backend"] = device.backend->name();
    object["index"] = device.index;
    object["hardware"] = device.hardware;
    if (device.yardstick) {
        set_known(object, "copy_bytes_per_s", device.yardstick->copy_bytes_per_s);
        set_known(object, "launch_s", device.yardstick->launch_s);
        for (const CopyRate& copy : device.yardstick->copies)
            if (copy.bytes_per_s > 0) object["copies"].push_back({copy.bytes, copy.bytes_per_s});
    }
    for (const auto& [math, test] : device.self_tests)
        object["self_test"][std::string(name_of(math))] = self_test_json(test);
    set_known(object, "problem", device.problem);
    return object;
}

void set_steadiness(json& section, const std::optional<MachineLoad>& load, const std::vector<Pulse>& pulses)
{
    if (load)
        section["load"] = {{"others", load->others}, {"average", load->average}, {"processors", load->processors}};
    for (const Pulse& pulse : pulses) {
        json readings = json::array();
        for (const Pulse::Reading& reading : pulse.readings)
            readings.push_back({reading.at_s, reading.seconds});
        section["pulses"].push_back({{"of", pulse.of},
                                     {"fastest_s", pulse.fastest_s()},
                                     {"ratio", pulse.ratio()},
                                     {"readings", std::move(readings)}});
    }
}

} // namespace tetrace
