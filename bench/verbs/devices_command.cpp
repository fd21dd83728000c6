#include "bench/options/identity.h"
#include "bench/output/report.h"
#include "bench/results/self_test_json.h"
#include "bench/rows/physical_device.h"
#include "bench/rows/rows.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "scenes/build_scene.h"

#include <algorithm>
#include <filesystem>
#include <fmt/ranges.h>
#include <map>

namespace tetrace {

namespace {

/// A device of one API.
struct ApiDevice {
    std::string label; ///< name in rows: "opencl", "opencl:1"
    Device device;
    std::size_t physical = 0; ///< devices with equal numbers are one piece of hardware
    std::optional<SelfTest> self_test;
    std::string self_test_text; ///< or why it failed; empty if the API runs none of our kernels
};

void run_self_test(ApiDevice& found, Backend& backend, std::size_t index)
{
    if (!found.device.usable) return;
    try {
        found.self_test = self_test_of(backend, index, MathMode::exact);
        if (found.self_test) found.self_test_text = found.self_test->text();
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        found.self_test_text = std::string("failed: ") + error.what();
    }
}

std::vector<ApiDevice> find_devices()
{
    std::vector<ApiDevice> found;
    std::vector<Device> devices;
    double done = 0;
    for (Backend* backend : all_backends()) {
        for (std::size_t i = 0; i < backend->devices().size(); ++i) {
            RowKey key;
            key.backend = backend->name();
            key.device = i;
            devices.push_back(backend->devices()[i]);
            found.push_back({device_label(key), devices.back(), 0, {}, {}});
            progress_line().show("testing devices", done / static_cast<double>(all_backends().size()), -1,
                                 found.back().label);
            run_self_test(found.back(), *backend, i);
        }
        done += 1;
    }
    const auto numbers = physical_devices(devices);
    for (std::size_t i = 0; i < found.size(); ++i)
        found[i].physical = numbers[i];
    return found;
}

Cell count_cell(std::uint64_t count)
{
    return count == 0 ? Cell() : Cell(count);
}

std::string backend_of(const ApiDevice& found)
{
    return found.label.substr(0, found.label.find(':'));
}

Table device_table(const std::vector<ApiDevice>& devices)
{
    Table table({{"backend", "backend"},
                 {"label", "label"},
                 {"device", "device"},
                 {"type", "type"},
                 {"driver", "driver"},
                 {"implementation", "implementation"},
                 {"physical_device", "physical device"},
                 {"id", "id"},
                 {"uuid", "UUID"},
                 {"pci", "PCI"},
                 {"library", "library"},
                 {"threads", "threads"},
                 {"memory_bytes", "memory", "bytes"},
                 {"max_buffer_bytes", "largest buffer", "bytes"},
                 {"cache_bytes", "largest cache", "bytes"},
                 {"max_group_items", "group"},
                 {"group_width", "lockstep"},
                 {"timer_period_s", "timer", "s", 9},
                 {"reports_code", "reports code"},
                 {"self_test", "self-test"},
                 {"status", "status"},
                 {"reason", "reason"}});
    for (const ApiDevice& found : devices) {
        const Device& device = found.device;
        table.add({backend_of(found),
                   found.label,
                   device.name,
                   std::string(name_of(device.kind)),
                   text_cell(device.driver),
                   text_cell(device.implementation),
                   std::uint64_t{found.physical},
                   text_cell(device.id),
                   text_cell(device.uuid),
                   text_cell(device.pci),
                   text_cell(device.library),
                   std::uint64_t{device.threads},
                   count_cell(device.memory_bytes),
                   count_cell(device.max_buffer_bytes),
                   count_cell(device.cache_bytes),
                   count_cell(device.max_group_items),
                   count_cell(device.group_width),
                   device.timer_period_s > 0 ? Cell(device.timer_period_s) : Cell(),
                   std::string(device.reports_code ? "yes" : "no"),
                   text_cell(found.self_test_text),
                   std::string(device.usable         ? "usable"
                               : device.compile_only ? "compile only"
                                                     : "missing"),
                   text_cell(device.reason)});
    }
    return table;
}

std::string joined(const std::vector<std::string>& parts)
{
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// A physical device: what is known of it under any API.
std::string heading(const std::vector<const ApiDevice*>& apis)
{
    std::vector<std::string> parts = {apis.front()->device.name};
    const auto add_first = [&](const char* title, std::string Device::*member) {
        for (const ApiDevice* api : apis)
            if (const std::string& text = api->device.*member; !text.empty()) {
                parts.push_back(title + text);
                return;
            }
    };
    const bool is_host = runs_on_host(apis.front()->device);
    if (!is_host) { // the ids that drivers make up for the processor identify only the driver
        add_first("UUID ", &Device::uuid);
        add_first("PCI ", &Device::pci);
    }
    if (apis.front()->device.memory_bytes > 0) parts.push_back(size_text(apis.front()->device.memory_bytes));
    if (is_host) parts.push_back(counted(host_identity().threads, "thread", "threads") + " for this process");
    return joined(parts) + "\n";
}

std::string limits_text(const Device& device)
{
    std::vector<std::string> parts;
    if (device.max_buffer_bytes > 0) parts.push_back("largest buffer " + size_text(device.max_buffer_bytes));
    if (device.max_group_items > 0) parts.push_back(fmt::format("groups of {}", with_commas(device.max_group_items)));
    if (device.cache_bytes > 0) parts.push_back("cache " + size_text(device.cache_bytes));
    if (device.group_width > 0) parts.push_back(fmt::format("{} in lockstep", device.group_width));
    if (device.timer_period_s > 0) parts.push_back(fmt::format("timer {:.3g} ns", 1e9 * device.timer_period_s));
    if (device.reports_code) parts.emplace_back("reports its code to 'inspect'");
    return joined(parts);
}

std::string api_text(const ApiDevice& found)
{
    constexpr std::size_t width = 110, margin = 13;
    const Device& device = found.device;
    std::string text =
        fmt::format("{}, {}{}{}", device.name, name_of(device.kind), device.driver.empty() ? "" : ", ", device.driver);
    if (const std::string limits = limits_text(device); !limits.empty()) text += "\n\n" + limits;
    if (!device.library.empty()) text += "\n\nlibrary: " + device.library;
    if (!found.self_test_text.empty()) text += "\n\nself-test: " + found.self_test_text;
    std::string lines = wrapped(text, width, margin);
    for (std::size_t gap; (gap = lines.find("\n\n")) != std::string::npos;) // keeps the facts of one device together
        lines.erase(gap, 1);
    return fmt::format("  {:<{}}", found.label, margin - 2) + lines.substr(margin);
}

std::string missing_text(const std::vector<ApiDevice>& devices)
{
    std::string text;
    for (const ApiDevice& found : devices)
        if (!found.device.usable)
            text +=
                fmt::format("  {:<11}", found.label) +
                wrapped((found.device.name == "none" ? "" : found.device.name + ": ") + found.device.reason, 110, 13)
                    .substr(13);
    return text.empty() ? text : "Not usable\n" + text + "\n";
}

std::string devices_text(const std::vector<ApiDevice>& devices)
{
    std::map<std::size_t, std::vector<const ApiDevice*>> groups;
    for (const ApiDevice& found : devices)
        if (found.device.usable) groups[found.physical].push_back(&found);
    std::string text;
    for (const auto& [number, apis] : groups) {
        text += heading(apis);
        for (const ApiDevice* api : apis)
            text += api_text(*api);
        text += "\n";
    }
    return text + missing_text(devices);
}

nlohmann::json devices_json(const std::vector<ApiDevice>& devices)
{
    nlohmann::json rows = to_json(device_table(devices));
    for (std::size_t i = 0; i < devices.size(); ++i) {
        rows[i]["reports_code"] = devices[i].device.reports_code;
        if (devices[i].self_test) rows[i]["self_test"] = self_test_json(*devices[i].self_test);
    }
    return rows;
}

struct Part {
    const char* name;
    bool present;
    const char* use;
    const char* remedy;
};

std::vector<Part> parts()
{
    const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    return {{"builder", !find_builder().empty(), "reads meshes, makes scenes",
             "install libtet1.5-dev (libtet-dev after Debian 13) and libcgal-dev, configure and build again"},
            {"images", std::filesystem::exists(folder / "tetrace_images.so"), "writes pictures",
             "install libopenimageio-dev, configure and build again"}};
}

Table part_table()
{
    Table table({{"part", "part"}, {"use", "use"}, {"status", "status"}, {"remedy", "remedy"}});
    for (const Part& part : parts())
        table.add({std::string(part.name), std::string(part.use), std::string(part.present ? "present" : "missing"),
                   part.present ? Cell() : Cell(part.remedy)});
    return table;
}

} // namespace

void require_devices(const std::vector<std::string>& backends)
{
    for (const std::string& name : backends) {
        const auto& devices = backend_named(name).devices();
        if (std::ranges::none_of(devices, &Device::usable))
            throw Error(ErrorKind::missing,
                        fmt::format("--require {}: no usable device here: {}", name, devices.front().reason));
    }
}

namespace {

void require_self_tests(const std::vector<std::string>& backends, const std::vector<ApiDevice>& devices)
{
    for (const ApiDevice& found : devices) {
        const bool required = std::ranges::find(backends, backend_of(found)) != backends.end();
        const bool has_none = !found.device.usable || found.self_test_text.empty();
        if (!required || has_none || (found.self_test && found.self_test->is_exact())) continue;
        throw Error(ErrorKind::driver, fmt::format("--require {}: {} is not exact: self-test: {}", backend_of(found),
                                                   found.label, found.self_test_text));
    }
}

} // namespace

int devices_command(const Options& options)
{
    check_output(options);
    const auto devices = find_devices();
    progress_line().clear();
    const Table optional = part_table();
    Report report{{}, device_table(devices), result_head(options)};
    report.sheet.verbatim(host_identity().system + "\n\n" + devices_text(devices));
    report.sheet.table(optional, 0);
    report.json["devices"] = devices_json(devices);
    report.json["parts"] = to_json(optional);
    report.json = {{"tetrace", report.json}};
    deliver(options, report);
    require_devices(options.required);
    require_self_tests(options.required, devices);
    return 0;
}

} // namespace tetrace
