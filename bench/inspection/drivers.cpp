#include "bench/inspection/drivers.h"

#include "bench/inspection/nvcc.h"
#include "bench/rows/rows.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

bool is_named(const Options& options, const Backend& backend)
{
    return std::ranges::find(options.backends, backend.name()) != options.backends.end();
}

Target target_of(Backend& backend, std::size_t device)
{
    RowKey key;
    key.backend = backend.name();
    key.device = device;
    return {device_label(key), Maker::driver, &backend, device};
}

void take_code(Inspected& row, const CompiledCode& compiled)
{
    row.status = InspectedStatus::ok;
    row.reason.clear();
    row.compiler = printable_line(compiled.compiler);
    if (compiled.lanes > 0) row.lanes = compiled.lanes;
    for (const auto& [name, value] : compiled.statistics)
        row.statistics[printable_line(name)] = value;
    take_statistics(row, row.statistics);
    const auto reports = read_ptxas(compiled.messages); // of the one kernel of an OpenCL program
    if (reports.empty()) return;
    const PtxasReport& report = reports.begin()->second;
    row.registers = report.registers;
    row.scratch_bytes = report.stack_bytes;
    row.spill_store_bytes = report.spill_store_bytes;
    row.spill_load_bytes = report.spill_load_bytes;
}

void ask(Inspected& row, const std::filesystem::path& code)
try {
    const Target& target = row.target;
    const CompiledCode compiled =
        target.backend->compiled(target.device, row.point.kernel, row.point.entry == Entry::outside, {});
    take_code(row, compiled);
    if (!code.empty() && !compiled.text.empty())
        write_whole(code / (target.name + code_file_name(row.point)), compiled.text);
} catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw;
    row.status = InspectedStatus::error;
    row.reason = printable_line(error.what());
}

} // namespace

std::vector<Target> driver_targets(const Options& options)
{
    std::vector<Target> targets;
    if (options.backends.empty() && options.devices.empty()) return targets;
    for (Backend* const backend : all_backends()) {
        if (!options.backends.empty() && !is_named(options, *backend)) continue;
        const auto& devices = backend->devices();
        const auto compiles = [](const Device& device) { return device.usable || device.compile_only; };
        for (std::size_t i = 0; i < devices.size(); ++i)
            if (compiles(devices[i]) && wanted_device(options, *backend, i)) targets.push_back(target_of(*backend, i));
        if (is_named(options, *backend) && std::ranges::none_of(devices, compiles))
            targets.push_back(target_of(*backend, 0));
    }
    if (targets.empty())
        throw Error(ErrorKind::missing, fmt::format("inspect: --device: no device{} has {} in its name, driver, "
                                                    "library, type, id or number; 'tetrace devices' lists them",
                                                    options.backends.empty() ? "" : " of these backends",
                                                    fmt::join(options.devices, " or ")));
    return targets;
}

std::vector<Inspected> ask_driver(const Target& target, const std::vector<EntryPoint>& points,
                                  const std::filesystem::path& code, const PartDone& tell)
{
    auto rows = unasked(target, points, "not compiled");
    Inspected nothing;
    try {
        take_code(nothing, target.backend->compiled(target.device, std::nullopt, true, {}));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        rows = unasked(target, points, printable_line(error.what()));
        if (error.kind() == ErrorKind::unsupported || error.kind() == ErrorKind::missing) return rows;
        for (Inspected& row : rows)
            row.status = InspectedStatus::error;
        return rows;
    }
    for (Inspected& row : rows) {
        tell(static_cast<double>(&row - rows.data()) / static_cast<double>(rows.size()));
        ask(row, code);
        if (row.subgroups && !row.max_subgroups) row.max_subgroups = nothing.subgroups;
    }
    return rows;
}

} // namespace tetrace
