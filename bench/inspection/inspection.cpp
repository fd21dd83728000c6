#include "bench/inspection/inspection.h"

#include "bench/inspection/null_hardware.h"
#include "bench/inspection/nvcc.h"
#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>

namespace tetrace {

namespace {

std::vector<EntryPoint> points_of(const Options& options, Maker maker)
{
    std::vector<EntryPoint> points = all_entry_points(maker);
    std::erase_if(points, [&](const EntryPoint& point) { return !wants(options, point); });
    return points;
}

bool is_skipped(const Inspected& row)
{
    return row.status == InspectedStatus::skipped;
}

} // namespace

Inspection inspect(const Options& options, const Progress& tell)
{
    const auto targets = targets_of(options.gpus);
    Inspection inspection;
    std::optional<Nvcc> nvcc; // looked for once, and only if it is needed
    for (const Target& target : targets) {
        const auto points = points_of(options, target.maker);
        if (points.empty() && target.maker == Maker::amd && !points_of(options, Maker::nvidia).empty()) continue;
        if (points.empty())
            throw Error(ErrorKind::usage, "inspect: no kernel has this combination of --structure, --method, --layout, "
                                          "--schedule, --math and --entry");
        const double first = static_cast<double>(&target - targets.data()), all = static_cast<double>(targets.size());
        const PartDone tell_part = [&](double part) { tell("compiling", (first + part) / all, "for " + target.name); };
        tell_part(0);
        if (target.maker == Maker::nvidia && !nvcc) nvcc = find_nvcc();
        const std::filesystem::path code = options.code_folder.value_or("");
        auto rows = target.maker == Maker::amd ? ask_null_hardware(target, points, code, tell_part)
                                               : ask_nvcc(*nvcc, target, points, code, tell_part);
        if (std::ranges::all_of(rows, is_skipped))
            inspection.skipped.push_back(fmt::format("{}: {}", target.name, rows.front().reason));
        std::ranges::move(rows, std::back_inserter(inspection.rows));
    }
    return inspection;
}

void require_asked(const Inspection& inspection, const std::vector<std::string>& required)
{
    for (const std::string& name : required) {
        if (std::ranges::none_of(inspection.rows, [&](const Inspected& row) { return row.target.name == name; }))
            throw Error(ErrorKind::usage,
                        fmt::format("--require {0}: {0} is not a target of this run; name it in --target too", name));
        for (const Inspected& row : inspection.rows)
            if (row.target.name == name && row.status != InspectedStatus::ok)
                throw Error(ErrorKind::missing,
                            fmt::format("--require {}: {} is {}: {}", name, name_of(row.point.kernel),
                                        name_of(row.status), row.reason));
    }
}

bool decides_fused(const Inspected& row)
{
    return row.fused_in() == FusedIn::decisions;
}

} // namespace tetrace
