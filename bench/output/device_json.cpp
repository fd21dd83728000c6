#include "bench/output/device_json.h"

#include "bench/options/browser_api.h"
#include "bench/results/result_file.h"
#include "bench/results/result_value.h"
#include "bench/results/self_test_json.h"
#include "core/base/printable.h"

#include <algorithm>

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

/// Calls visit(key, member) for each number of a device.
template <class AnyDevice, class Visit>
void each_number(AnyDevice& device, const Visit& visit)
{
    visit("memory_bytes", device.memory_bytes);
    visit("max_buffer_bytes", device.max_buffer_bytes);
    visit("max_group_items", device.max_group_items);
    visit("group_width", device.group_width);
    visit("timer_period_s", device.timer_period_s);
    visit("threads", device.threads);
    visit("max_steps", device.max_steps);
    visit("cache_bytes", device.cache_bytes);
}

} // namespace

json device_json(const Device& device)
{
    json object = {{"name", device.name}, {"type", name_of(device.kind)}, {"driver", device.driver}, {"id", device.id}};
    set_known(object, "implementation", device.implementation);
    set_known(object, "uuid", device.uuid);
    set_known(object, "pci", device.pci);
    set_known(object, "library", device.library);
    each_number(device, [&](const char* key, const auto& value) { set_known(object, key, value); });
    return object;
}

Device device_from(const ResultValue& value)
{
    Device device;
    for (const auto& [key, member] : {std::pair("name", &Device::name),
                                      {"driver", &Device::driver},
                                      {"id", &Device::id},
                                      {"implementation", &Device::implementation},
                                      {"uuid", &Device::uuid},
                                      {"pci", &Device::pci},
                                      {"library", &Device::library}})
        device.*member = printable_line(value.text_at(key));
    device.kind = device_kind_of(value);
    each_number(device, [&](const char* key, auto& member) { read_member(member, value, key); });
    return device;
}

json row_device_json(const RowDevice& device)
{
    json object = device_json(device.device);
    object["backend"] = device.backend;
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

namespace {

/// As many as this program can hold.
decltype(Yardstick::copies) copies_from(const ResultValue& device)
{
    decltype(Yardstick::copies) copies{};
    const auto list = device.find("copies");
    if (!list) return copies;
    const auto items = list->items();
    for (std::size_t i = 0; i < std::min(copies.size(), items.size()); ++i) {
        const auto pair = items[i].items();
        if (pair.size() != 2) items[i].reject("is not a pair of bytes and bytes per second");
        copies[i] = {pair[0].count(), pair[1].number()};
    }
    return copies;
}

} // namespace

RowDevice row_device_from(const ResultValue& value)
{
    RowDevice device;
    device.backend = value.at("backend").line();
    if (!is_known_api(device.backend)) value.at("backend").reject("is not a backend of this tetrace");
    device.index = value.at("index").count();
    device.device = device_from(value);
    device.hardware = value.at("hardware").count();
    Yardstick yardstick{0, 0, copies_from(value)};
    read_member(yardstick.copy_bytes_per_s, value, "copy_bytes_per_s");
    read_member(yardstick.launch_s, value, "launch_s");
    if (yardstick.copy_bytes_per_s > 0 || yardstick.launch_s > 0) device.yardstick = yardstick;
    if (const auto tests = value.find("self_test"))
        for (const auto& [math, test] : tests->members())
            device.self_tests[math == "fast" ? MathMode::fast : MathMode::exact] = self_test_from(test);
    device.problem = printable_text(value.text_at("problem"));
    return device;
}

void set_steadiness(json& section, const std::optional<MachineLoad>& load, const std::vector<Pulse>& pulses)
{
    if (load)
        section["load"] = {{"others", load->others}, {"average", load->average}, {"processors", load->processors}};
    if (load && load->throttling.periods > 0) {
        section["load"]["throttled_periods"] = load->throttling.periods;
        section["load"]["throttled_s"] = load->throttling.seconds;
    }
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
