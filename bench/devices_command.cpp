#include "bench/commands.h"
#include "bench/identity.h"
#include "bench/progress.h"
#include "bench/report.h"
#include "bench/text.h"
#include "core/backend.h"
#include "core/error.h"
#include "scenes/build_scene.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace tetrace {

namespace {

Table device_table()
{
    Table table({{"backend", "backend"},
                 {"device", "device"},
                 {"type", "type"},
                 {"driver", "driver"},
                 {"threads", "threads"},
                 {"memory_bytes", "memory", "bytes"},
                 {"status", "status"},
                 {"reason", "reason"}});
    for (const Backend* backend : all_backends())
        for (const Device& device : backend->devices())
            table.add({backend->name(), device.name, device.type, device.driver, std::uint64_t{device.threads},
                       device.memory_bytes > 0 ? Cell(device.memory_bytes) : Cell(),
                       std::string(device.usable ? "usable" : "missing"),
                       device.usable ? Cell() : Cell(device.reason)});
    return table;
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
             "install libtet1.5-dev and libcgal-dev, configure and build again"},
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

bool has_usable_device(const std::string& name)
{
    for (const Backend* backend : all_backends()) {
        const auto devices = backend->devices();
        if (backend->name() == name &&
            std::any_of(devices.begin(), devices.end(), [](const Device& device) { return device.usable; }))
            return true;
    }
    return false;
}

} // namespace

void require_devices(const std::vector<std::string>& backends)
{
    for (const std::string& name : backends)
        if (!has_usable_device(name))
            throw Error(ErrorKind::missing,
                        fmt::format("--require {}: this backend has no usable device here; 'tetrace "
                                    "devices' tells the reason",
                                    name));
}

int devices_command(const Options& options)
{
    check_output(options);
    const Table devices = device_table(), optional = part_table();
    const HostIdentity host = host_identity();
    Report report{fmt::format("{}\n{}, {} threads for this process\n\n{}\n{}", host.cpu, host.system, host.threads,
                              devices.text(), optional.text()),
                  devices, result_head(options)};
    report.json["devices"] = to_json(devices);
    report.json["parts"] = to_json(optional);
    report.json = {{"tetrace", report.json}};
    deliver(options, report);
    require_devices(options.required);
    return 0;
}

} // namespace tetrace
