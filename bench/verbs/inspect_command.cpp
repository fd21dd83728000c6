#include "bench/inspection/drivers.h"
#include "bench/inspection/inspection.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/variants/variant_inspection.h"
#include "bench/variants/variant_report.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace tetrace {

namespace {

void make_code_folder(const Options& options)
{
    if (!options.code_folder) return;
    std::error_code failed;
    std::filesystem::create_directories(*options.code_folder, failed);
    if (failed)
        throw Error(ErrorKind::invalid_input,
                    "--code: the folder '" + options.code_folder->string() + "' cannot be made: " + failed.message());
}

/// Names of GPUs as --target has them, and of the devices that --backend and --device keep.
void check_required(const Options& options)
{
    if (options.required.empty()) return;
    const auto drivers = driver_targets(options);
    for (const std::string& name : options.required)
        if (std::ranges::none_of(drivers, [&](const Target& target) { return target.name == name; }))
            static_cast<void>(parse_target("--require-target", name));
}

int inspect_variants_command(const Options& options)
{
    const StopWhenInterrupted stop;
    something_to_keep();
    const Budget budget(options.budget_s);
    const std::vector<VariantRow> rows = inspect_variants(options, budget);
    deliver(options, variant_report(rows, {}, {}, options));
    if (is_interrupted()) return end_interrupted_with_result(options);
    for (const std::string& name : options.required)
        if (std::ranges::none_of(rows, [&](const VariantRow& row) { return row.label == name && row.ran > 0; }))
            throw Error(ErrorKind::missing, fmt::format("--require-target {0}: no variant was compiled for {0}", name));
    return exit_code(rows);
}

} // namespace

int inspect_command(const Options& options)
{
    check_output(options);
    check_required(options);
    if (options.variants > 0) return inspect_variants_command(options);
    make_code_folder(options);
    const Inspection inspection = inspect(options, progress_line().callback());
    progress_line().clear();
    deliver(options, inspection_report(inspection, options));
    require_asked(inspection, options.required);
    const auto has = [&](auto matches) { return std::ranges::any_of(inspection.rows, matches); };
    if (has(decides_fused)) return exit_code(ErrorKind::wrong_result);
    if (has([](const Inspected& row) { return row.status == InspectedStatus::error; }))
        return exit_code(ErrorKind::internal);
    if (!has([](const Inspected& row) { return row.status == InspectedStatus::ok; }))
        throw Error(ErrorKind::missing, "inspect: no target could be compiled for");
    return 0;
}

} // namespace tetrace
