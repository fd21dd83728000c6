#include "bench/inspection/inspection.h"

#include "bench/inspection/drivers.h"
#include "bench/inspection/hipcc.h"
#include "bench/inspection/null_hardware.h"
#include "bench/inspection/nvcc.h"
#include "core/base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

namespace tetrace {

std::vector<EntryPoint> points_of(const Options& options, const Target& target)
{
    std::vector<EntryPoint> points = all_entry_points(target.maker);
    std::erase_if(points, [&](const EntryPoint& point) {
        return !wants(options, point) || (target.backend != nullptr && !target.backend->has_kernel(point.kernel));
    });
    return points;
}

namespace {

/// Those of --target, and the devices that --backend and --device keep; without these options, the usual GPUs.
std::vector<Target> asked_targets(const Options& options)
{
    auto targets = driver_targets(options);
    if (targets.empty() || !options.gpus.empty()) {
        const auto gpus = targets_of(options.gpus);
        targets.insert(targets.begin(), gpus.begin(), gpus.end());
    }
    return targets;
}

bool is_skipped(const Inspected& row)
{
    return row.status == InspectedStatus::skipped;
}

} // namespace

Inspection inspect(const Options& options, const Progress& tell)
{
    const auto targets = asked_targets(options);
    if (std::ranges::all_of(targets, [&](const Target& target) { return points_of(options, target).empty(); }))
        throw Error(ErrorKind::usage, "inspect: no kernel has this combination of --structure, --method, --layout, "
                                      "--schedule, --math, --entry, --backend and --target");
    Inspection inspection;
    std::optional<Nvcc> nvcc; // looked for once, and only if it is needed
    std::optional<Hipcc> hipcc;
    for (const Target& target : targets) {
        const auto points = points_of(options, target);
        if (points.empty()) {
            if (target.maker == Maker::driver)
                inspection.skipped.push_back(target.name + ": has none of these kernels");
            continue;
        }
        const double first = static_cast<double>(&target - targets.data()), all = static_cast<double>(targets.size());
        const PartDone tell_part = [&](double part) { tell("compiling", (first + part) / all, "for " + target.name); };
        tell_part(0);
        if (target.maker == Maker::nvidia && !nvcc) nvcc = find_nvcc();
        if (target.maker == Maker::hip && !hipcc) hipcc = find_hipcc();
        const std::filesystem::path code = options.code_folder.value_or("");
        auto rows = target.maker == Maker::amd      ? ask_null_hardware(target, points, code, tell_part)
                    : target.maker == Maker::nvidia ? ask_nvcc(*nvcc, target, points, code, tell_part)
                    : target.maker == Maker::hip    ? ask_hipcc(*hipcc, target, points, code, tell_part)
                                                    : ask_driver(target, points, code, tell_part);
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
                        fmt::format("--require-target {0}: {0} is not a target of this run; name it in --target, or by "
                                    "--backend or --device",
                                    name));
        for (const Inspected& row : inspection.rows)
            if (row.target.name == name && row.status != InspectedStatus::ok)
                throw Error(ErrorKind::missing,
                            fmt::format("--require-target {}: {} is {}: {}", name, name_of(row.point.kernel),
                                        name_of(row.status), row.reason));
    }
}

bool decides_fused(const Inspected& row)
{
    return row.fused_in() == FusedIn::decisions;
}

namespace {

std::string fused_text(const Inspected& row)
{
    const auto in = row.fused_in();
    if (!in) return {};
    if (*in == FusedIn::nothing) return "none";
    if (*in == FusedIn::boxes) return fmt::format("boxes: {}", *row.fused);
    return fmt::format("{}: {}", *in == FusedIn::decisions ? "DECISIONS" : "free", *row.fused);
}

Cell percent_cell(const std::optional<double>& share)
{
    return share ? Cell(100 * *share) : Cell();
}

Table inspection_table(const Inspection& inspection)
{
    Table table({{"target", "target"},
                 {"method", "method"},
                 {"layout", "layout"},
                 {"math", "math"},
                 {"entry", "entry"},
                 {"registers", "registers"},
                 {"scalar_registers", "scalar"},
                 {"spilled_registers", "spilled"},
                 {"spill_store_bytes", "spill stores", "bytes"},
                 {"spill_load_bytes", "spill loads", "bytes"},
                 {"scratch_bytes", "scratch", "bytes"},
                 {"subgroups", "subgroups"},
                 {"occupancy", "occupancy", "%", 0},
                 {"instructions", "instructions"},
                 {"code_bytes", "code", "bytes"},
                 {"branches", "branches"},
                 {"loads", "loads"},
                 {"loads_in_loops", "in loops"},
                 {"latency_cycles", "latency", "cycles", 0},
                 {"cycles_a_subgroup", "per subgroup", "cycles", 0},
                 {"fused", "fused"},
                 {"status", "status"},
                 {"reason", "reason"}});
    for (const Inspected& row : inspection.rows) {
        const KernelId& kernel = row.point.kernel;
        table.add({row.target.name,
                   std::string(name_of(kernel.method)),
                   std::string(name_of(kernel.layout)),
                   std::string(name_of(kernel.math)),
                   name_of(row.point),
                   cell_of(row.registers),
                   cell_of(row.scalar_registers),
                   cell_of(row.spilled_registers),
                   cell_of(row.spill_store_bytes),
                   cell_of(row.spill_load_bytes),
                   cell_of(row.scratch_bytes),
                   cell_of(row.subgroups),
                   percent_cell(row.occupancy()),
                   cell_of(row.instructions),
                   cell_of(row.code_bytes),
                   cell_of(row.branches),
                   cell_of(row.loads),
                   cell_of(row.loads_in_loops),
                   cell_of(row.latency_cycles),
                   cell_of(row.cycles_a_subgroup),
                   text_cell(fused_text(row)),
                   std::string(name_of(row.status)),
                   text_cell(row.reason)});
    }
    return table;
}

/// The columns that fit the terminal; every format of the result has all columns.
Table short_table(const Inspection& inspection)
{
    Table table({{"target", "target"},
                 {"kernel", "kernel"},
                 {"entry", "entry"},
                 {"registers", "registers"},
                 {"spilled", "spilled"},
                 {"scratch", "scratch", "bytes"},
                 {"subgroups", "subgroups"},
                 {"occupancy", "occupancy", "%", 0},
                 {"code", "code", "bytes"},
                 {"instructions", "instructions"},
                 {"branches", "branches"},
                 {"loads", "loads in loops"},
                 {"latency", "latency", "cycles", 0},
                 {"fused", "fused"},
                 {"status", "status"}});
    for (const Inspected& row : inspection.rows) {
        const KernelId& kernel = row.point.kernel;
        const auto spilled = row.spilled_registers ? Cell(*row.spilled_registers)
                             : row.spill_store_bytes
                                 ? Cell(fmt::format("{} + {} bytes", *row.spill_store_bytes, *row.spill_load_bytes))
                                 : Cell();
        table.add({row.target.name,
                   fmt::format("{} {}{}", name_of(kernel.method), name_of(kernel.layout),
                               kernel.math == MathMode::fast ? " fast" : ""),
                   name_of(row.point), cell_of(row.registers), spilled, cell_of(row.scratch_bytes),
                   cell_of(row.subgroups), percent_cell(row.occupancy()), cell_of(row.code_bytes),
                   cell_of(row.instructions), cell_of(row.branches), cell_of(row.loads_in_loops),
                   cell_of(row.latency_cycles), text_cell(fused_text(row)), std::string(name_of(row.status))});
    }
    return table;
}

template <class T>
void set_known(nlohmann::json& object, const char* key, const std::optional<T>& value)
{
    if (value) object[key] = *value;
}

nlohmann::json row_json(const Inspected& row)
{
    const KernelId& kernel = row.point.kernel;
    nlohmann::json object = {{"target", row.target.name},         {"structure", name_of(kernel.structure)},
                             {"method", name_of(kernel.method)},  {"layout", name_of(kernel.layout)},
                             {"math", name_of(kernel.math)},      {"schedule", name_of(kernel.schedule)},
                             {"entry", name_of(row.point.entry)}, {"status", name_of(row.status)}};
    if (!row.reason.empty()) object["reason"] = row.reason;
    if (!row.compiler.empty()) object["compiler"] = row.compiler;
    const std::pair<const char*, Inspected::Count> counts[] = {{"registers", row.registers},
                                                               {"scalar_registers", row.scalar_registers},
                                                               {"spilled_registers", row.spilled_registers},
                                                               {"spill_store_bytes", row.spill_store_bytes},
                                                               {"spill_load_bytes", row.spill_load_bytes},
                                                               {"scratch_bytes", row.scratch_bytes},
                                                               {"lanes", row.lanes},
                                                               {"subgroups", row.subgroups},
                                                               {"most_subgroups", row.max_subgroups},
                                                               {"code_bytes", row.code_bytes},
                                                               {"instructions", row.instructions},
                                                               {"branches", row.branches},
                                                               {"loads", row.loads},
                                                               {"loads_in_loops", row.loads_in_loops},
                                                               {"fused", row.fused},
                                                               {"divisions", row.divisions},
                                                               {"sass_fused", row.sass_fused}};
    for (const auto& [key, count] : counts)
        set_known(object, key, count);
    if (!row.statistics.empty()) object["statistics"] = row.statistics;
    set_known(object, "latency_cycles", row.latency_cycles);
    set_known(object, "cycles_a_subgroup", row.cycles_a_subgroup);
    if (const auto in = row.fused_in()) object["fused_in"] = name_of(*in);
    if (!row.first_fused.empty()) object["first_fused"] = row.first_fused;
    return object;
}

std::string failures_text(const Inspection& inspection)
{
    std::string text;
    for (const Inspected& row : inspection.rows) {
        const std::string name =
            fmt::format("{} {} {}", row.target.name, name_of(row.point.kernel), name_of(row.point));
        if (decides_fused(row))
            text += fmt::format("{}: {} fused operations decide signs{}\n", name, *row.fused,
                                row.first_fused.empty() ? "" : fmt::format("; the first is '{}'", row.first_fused));
        if (row.status == InspectedStatus::error) text += fmt::format("{}: {}\n", name, row.reason);
    }
    return text;
}

std::string skipped_text(const Inspection& inspection)
{
    std::string text;
    for (const std::string& sentence : inspection.skipped)
        text += "skipped: " + sentence + "\n";
    return text;
}

} // namespace

Report inspection_report(const Inspection& inspection, const Options& options)
{
    const std::string failures = failures_text(inspection), skipped = skipped_text(inspection);
    nlohmann::json section = result_head(options);
    section["programs"] = nlohmann::json::array();
    for (const Inspected& row : inspection.rows)
        section["programs"].push_back(row_json(row));
    section["skipped_targets"] = inspection.skipped;
    Report report{{}, inspection_table(inspection), {{"tetrace", std::move(section)}}};
    report.sheet.table(short_table(inspection), 0);
    if (!(failures + skipped).empty()) report.sheet.gap();
    report.sheet.verbatim(failures + skipped);
    if (options.out) report.sheet.gap();
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

} // namespace tetrace
