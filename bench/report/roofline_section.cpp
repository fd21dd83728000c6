#include "bench/report/charts/axis.h"
#include "bench/report/charts/roofline_chart.h"
#include "bench/report/sections.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace tetrace {

namespace {

const char* const how_to_read_roofs =
    "Msteps/s against the ceiling set by memory: the device's copy bandwidth in the same run (bytes read and "
    "written), over the bytes that a step loads of its tet's record. A row's ceiling is that of the memory level "
    "that holds its scene: the fastest copy whose buffers were at least as large. Both are estimates, not limits: "
    "memory moves whole cache lines, which lowers the rate, and nearer caches keep some of them, which can lift a "
    "row above its line. Percentages are shares of the ceiling.";

/// A device of a result under its roof.
struct DeviceRoof {
    std::string title;
    DeviceKind kind = DeviceKind::cpu;
    Roofline roofline;
    std::optional<double> launch_s, max_launch_share;
};

/// Scenes of a result get shapes in their order.
std::size_t scene_number(const ResultFile& file, const std::string& scene)
{
    const auto found = std::ranges::find_if(file.scenes, [&](const ResultScene& other) { return other.name == scene; });
    return static_cast<std::size_t>(found - file.scenes.begin());
}

void add_row(DeviceRoof& roof, const ReportRow& row, const ReportInput& input)
{
    const RowRate& rate = *row.rate;
    roof.kind = row.kind();
    roof.roofline.points.push_back({row.name(), row.walk_and_rays() + "  " + row.row->scene,
                                    scene_number(input.files.at(row.file), row.row->scene), *rate.bytes_per_step,
                                    *rate.msteps_per_s, rate.ceiling_bytes_per_s.value_or(0)});
    if (rate.launch_share) roof.max_launch_share = std::max(roof.max_launch_share.value_or(0), *rate.launch_share);
}

/// Empty for a device without a measured bandwidth, or without a row that has steps.
std::optional<DeviceRoof> roof_of(const ResultValue& device, std::size_t file, const ReportInput& input)
{
    const auto bandwidth = device.find("copy_bytes_per_s");
    if (!bandwidth) return std::nullopt;
    DeviceRoof roof;
    const std::string api = api_name(device.at("backend").line(), device.at("index").count());
    const std::string name = input.files[file].head.shown(device.at("name").line());
    roof.title = api + ": " + with_letter(name, file, input.files.size());
    roof.roofline.copy_bytes_per_s = bandwidth->number();
    if (roof.roofline.copy_bytes_per_s < 1 || roof.roofline.copy_bytes_per_s > 1e18)
        bandwidth->reject("is not between 1 and 1e18");
    if (const auto launch = device.find("launch_s")) roof.launch_s = launch->number();
    for (const ReportRow& row : input.rows)
        if (row.file == file && row.api == api && row.rate && row.rate->msteps_per_s && row.rate->bytes_per_step)
            add_row(roof, row, input);
    if (roof.roofline.points.empty()) return std::nullopt;
    std::ranges::stable_sort(roof.roofline.points, [](const RooflinePoint& a, const RooflinePoint& b) {
        return a.msteps_per_s > b.msteps_per_s;
    });
    roof.roofline.label = "Roofline of " + roof.title;
    return roof;
}

std::string launch_text(const DeviceRoof& roof)
{
    std::string text;
    if (roof.launch_s) text = fmt::format("An empty launch takes {} µs", short_number(1e6 * *roof.launch_s));
    if (roof.max_launch_share)
        text += fmt::format("{} at most {} of a row's wall time",
                            text.empty() ? "Launching and waiting take" : "; launching and waiting are",
                            short_percent(*roof.max_launch_share));
    return text.empty() ? text : text + ".";
}

Html charts_of(const std::vector<DeviceRoof>& roofs, DeviceKind kind, const char* title)
{
    Html charts;
    for (const DeviceRoof& roof : roofs)
        if (roof.kind == kind) charts += figure(roof.title, draw(roof.roofline), launch_text(roof));
    return charts.empty() ? charts : heading(title) + side_by_side(charts);
}

} // namespace

Section roofline_section(const ReportInput& input)
{
    std::vector<DeviceRoof> roofs;
    for (std::size_t file = 0; file < input.files.size(); ++file)
        if (const auto devices = input.files[file].section().find("devices"))
            for (const ResultValue& device : devices->items())
                if (auto roof = roof_of(device, file, input)) roofs.push_back(*std::move(roof));
    Section section{"roofline", "Roofline", {}};
    if (!roofs.empty())
        section.content = note(how_to_read_roofs) + charts_of(roofs, DeviceKind::cpu, "Processors") +
                          charts_of(roofs, DeviceKind::gpu, "GPUs") +
                          charts_of(roofs, DeviceKind::emulated, "Emulated on the CPU");
    return section;
}

} // namespace tetrace
