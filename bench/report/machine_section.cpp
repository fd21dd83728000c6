#include "bench/output/trust.h"
#include "bench/report/charts/axis.h"
#include "bench/report/sections.h"
#include "bench/results/row_keys.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

Html scaled(const ResultValue& object, const char* key, double factor)
{
    const auto value = object.find(key);
    return value ? text(short_number(factor * value->number())) : Html();
}

Html count_at(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    return value ? text(with_commas(value->count())) : Html();
}

/// "3 of 30" timed rows.
Html noisy_rows_of(const ResultValue& section)
{
    const Steadiness steadiness = read_steadiness(section);
    return steadiness.timed == 0 ? Html() : text(fmt::format("{} of {}", steadiness.noisy, steadiness.timed));
}

/// How many processors other work took while rows were timed.
Html others_of(const ResultValue& section)
{
    const auto load = section.find("load");
    return load ? text(fmt::format("{:.2f}", load->at("others").number())) : Html();
}

/// The slowest pulse of the host, and of each GPU, over its fastest.
Html pulses_of(const ResultValue& section)
{
    const auto pulses = section.find("pulses");
    if (!pulses) return {};
    std::string ratios;
    for (const ResultValue& pulse : pulses->items())
        append_item(ratios, ", ", fmt::format("{:.2f}", pulse.at("ratio").number()));
    return text(ratios);
}

const char* const about_the_machine =
    "others: CPUs used by other processes while rows were timed. calibration: a fixed piece of work, repeated "
    "throughout, on the host and then on each GPU: slowest over fastest. 1.00 is an undisturbed machine.";

Html results_table(const ReportInput& input)
{
    HtmlTable table({{"result"},
                     {"file"},
                     {"verb"},
                     {"date", "UTC"},
                     {"processor"},
                     {"system"},
                     {"threads", {}, true},
                     {"samples", "per row", true},
                     {"noisy", "rows", true},
                     {"others", "processors", true},
                     {"calibration", "slowest", true},
                     {"commit"},
                     {"compiler"}});
    for (std::size_t i = 0; i < input.files.size(); ++i) {
        const ResultFile& file = input.files[i];
        const ResultHead& head = file.head;
        const ResultValue section = file.section();
        const std::string letter = file_letter(i, input.files.size());
        table.add({letter.empty() ? Html() : text_element("b", "", letter),
                   text_element("code", "", file.path.filename().string()), text(head.verb),
                   text_element("span", "date", minute_of(head.date)), text(head.machine), text(head.system),
                   count_at(section, "threads"), count_at(section, "samples_a_row"), noisy_rows_of(section),
                   others_of(section), pulses_of(section), text_element("code", "", head.commit),
                   text(section.text_at("compiler"))});
    }
    const bool tells = std::ranges::any_of(input.files, [](const ResultFile& file) {
        return file.section().find("load").has_value() || file.section().find("pulses").has_value();
    });
    return table.html() + (tells ? note(about_the_machine) : Html());
}

/// A device as results record it; several results may record the same one.
struct ToldDevice {
    std::string host, api, name, driver, self_test, problem;
    DeviceKind kind = DeviceKind::cpu;
    std::string letters;
    Html copy, launch, memory;
};

std::string self_test_text(const ResultValue& device)
{
    const auto tests = device.find("self_test");
    const auto exact = tests ? tests->find("exact") : std::nullopt;
    return exact && exact->json().is_object() ? exact->text_at("text") : std::string();
}

std::string api_of(const ResultValue& backend, const std::optional<ResultValue>& index)
{
    return api_name(backend.line(), index ? index->count() : 0);
}

ToldDevice device_of_bench(const ResultValue& device)
{
    ToldDevice told;
    told.api = api_of(device.at("backend"), device.find("index"));
    told.name = device.at("name").line();
    told.kind = device_kind_of(device);
    told.driver = device.text_at("driver");
    told.self_test = self_test_text(device);
    told.problem = device.text_at("problem");
    told.copy = scaled(device, "copy_bytes_per_s", 1e-9);
    told.launch = scaled(device, "launch_s", 1e6);
    told.memory = scaled(device, "memory_bytes", 1e-9);
    return told;
}

/// Results of `check`, and of schema version 1, record devices only with their rows.
std::optional<ToldDevice> device_of_row(const ResultValue& row)
{
    const auto device = row.find(row_key::device);
    if (!device) return std::nullopt;
    ToldDevice told;
    told.api = api_of(row.at(row_key::backend), row.find(row_key::device_index));
    told.name = device->at("name").line();
    told.kind = device_kind_of(*device);
    told.driver = device->text_at("driver");
    told.memory = scaled(*device, "memory_bytes", 1e-9);
    if (const auto test = row.find(row_key::self_test)) told.self_test = test->text_at("text");
    return told;
}

std::vector<ToldDevice> devices_of(const ResultFile& file)
{
    std::vector<ToldDevice> told;
    const ResultValue section = file.section();
    if (const auto devices = section.find("devices")) {
        if (file.head.verb == "devices") return told; // has them in another form, and lacks rows
        for (const ResultValue& device : devices->items())
            told.push_back(device_of_bench(device));
    } else if (const auto rows = section.find("rows"); rows && !file.rows.empty()) {
        std::set<std::string> seen;
        for (const ResultValue& row : rows->items())
            if (auto device = device_of_row(row); device && seen.insert(device->api).second)
                told.push_back(*std::move(device));
    }
    return told;
}

/// Devices of all results. A device is listed once where several results record it alike, apart from what only one of
/// them measured.
std::vector<ToldDevice> all_devices(const ReportInput& input)
{
    std::vector<ToldDevice> all;
    for (std::size_t i = 0; i < input.files.size(); ++i)
        for (ToldDevice& device : devices_of(input.files[i])) {
            const ResultHead& head = input.files[i].head;
            device.host = head.machine;
            device.name = head.shown(device.name);
            device.letters = file_letter(i, input.files.size());
            const auto same = std::ranges::find_if(all, [&](const ToldDevice& other) {
                return other.host == device.host && other.api == device.api && other.name == device.name &&
                       other.driver == device.driver && (other.copy.empty() || device.copy.empty());
            });
            if (same == all.end()) {
                all.push_back(std::move(device));
                continue;
            }
            same->letters += " " + device.letters;
            if (same->copy.empty()) same->copy = device.copy, same->launch = device.launch;
        }
    return all;
}

/// "exact; division correctly rounded": the text after the first semicolon is in small letters below the verdict.
Html verdict_and_rest(const std::string& self_test)
{
    const std::size_t end = self_test.find("; ");
    if (end == std::string::npos) return text(self_test);
    return text(self_test.substr(0, end)) + text_element("small", "", self_test.substr(end + 2));
}

Html device_table(const ReportInput& input)
{
    HtmlTable table({{"result"},
                     {"API"},
                     {"device"},
                     {"type"},
                     {"driver"},
                     {"memory", "GB", true},
                     {"copy", "GB/s", true},
                     {"launch", "µs", true},
                     {"self-test, exact mode"},
                     {"problem"}});
    for (const ToldDevice& device : all_devices(input))
        table.add({text(device.letters), text(device.api), text(device.name),
                   text_element("span", device.kind == DeviceKind::emulated ? "type emulated" : "type",
                                std::string(name_of(device.kind))),
                   text(device.driver), device.memory, device.copy, device.launch, verdict_and_rest(device.self_test),
                   text(device.problem)});
    if (table.empty()) return {};
    return heading("Devices") + table.html() +
           note("copy: memory of the device copied to its own memory, bytes read and written; launch: an empty "
                "kernel, from launching to the end of waiting. Emulated devices are APIs of GPUs that run on the "
                "CPU.");
}

std::string steps_text(const ResultFile& file, const std::string& scene)
{
    for (const ResultValue& row : file.section().at("rows").items()) {
        const auto mean = row.at(row_key::scene).line() == scene ? row.find(row_key::mean_steps) : std::nullopt;
        if (mean) return fmt::format("{:.2f}", mean->number());
    }
    return {};
}

Html scene_table(const ReportInput& input)
{
    HtmlTable table({{"scene"},
                     {"from"},
                     {"tets", {}, true},
                     {"occlusive", "faces", true},
                     {"free", "faces", true},
                     {"domain"},
                     {"switches"},
                     {"rays"},
                     {"steps", "per ray", true},
                     {"hash"}});
    std::set<std::string> seen;
    for (const ResultFile& file : input.files)
        for (std::size_t i = 0; i < file.scenes.size(); ++i) {
            const ResultScene& scene = file.scenes[i];
            if (!seen.insert(scene.name + scene.hash + views_text(scene)).second) continue;
            const ResultValue value = file.section().at("scenes").items().at(i);
            table.add({text(scene.name), text(value.text_at("source")), count_at(value, "tets"),
                       count_at(value, "occlusive_faces"), count_at(value, "free_faces"), text(value.text_at("domain")),
                       text_element("code", "", value.text_at("switches")), text(views_text(scene)),
                       text(file.rows.empty() ? "" : steps_text(file, scene.name)),
                       text_element("code", "", scene.hash)});
        }
    return table.empty() ? Html() : heading("Scenes") + table.html();
}

/// Sentences about scenes and devices that were not available.
Html missing_list(const ReportInput& input)
{
    Html items;
    for (const ResultFile& file : input.files)
        for (const char* const key : {"missing_devices", "missing_scenes"})
            if (const auto sentences = file.section().find(key))
                for (const ResultValue& sentence : sentences->items())
                    items += text_element("li", "", sentence.text());
    return items.empty() ? items : heading("Missing") + element("ul", {{"class", "missing"}}, items);
}

} // namespace

Section machine_section(const ReportInput& input)
{
    return {"machines", "Machines and devices",
            results_table(input) + device_table(input) + scene_table(input) + missing_list(input)};
}

} // namespace tetrace
