#include "bench/measuring/scene_rows.h"
#include "bench/options/identity.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/variants/variant_program.h"
#include "bench/variants/variant_report.h"
#include "bench/variants/variant_run.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

void write_junit(const std::vector<VariantRow>& rows, const Options& options, const std::string& problem = {})
{
    if (!options.junit) return;
    std::string xml = variant_junit(rows, problem);
    if (options.anonymous) xml = anonymous_text(xml, options);
    if (prints_junit(options))
        print(xml);
    else
        write_whole(*options.junit, xml);
}

/// A required backend has not been checked if none of its variants ran.
void require_variants(const std::vector<VariantRow>& rows, const std::vector<std::string>& backends)
{
    for (const std::string& name : backends)
        if (std::ranges::none_of(rows,
                                 [&](const VariantRow& row) { return row.row.key.backend == name && row.ran > 0; }))
            throw Error(ErrorKind::missing, fmt::format("--require {0}: no variant ran on {0}", name));
}

/// Kernels of these backends can be compiled where the program runs; openmp's are parts of it. With --backend, others
/// are rows with a reason.
std::vector<RowKey> keys_of(const Options& options)
{
    std::vector<RowKey> keys = selected_rows(options, [](const std::string&) { return true; });
    const std::vector<std::string> compiling = backends_with_texts();
    if (options.backends.empty())
        std::erase_if(keys,
                      [&](const RowKey& key) { return std::ranges::find(compiling, key.backend) == compiling.end(); });
    if (keys.empty())
        throw Error(ErrorKind::missing,
                    fmt::format("--variants: no device of {} has a selected row", fmt::join(compiling, ", ")));
    return keys;
}

/// Programs that are used once would fill the drivers' own caches.
void keep_out_of_caches()
{
    ::setenv("POCL_KERNEL_CACHE", "0", 0);
    ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
}

} // namespace

int check_variants(const Options& options)
{
    check_output(options);
    if (options.junit && !prints_junit(options)) check_writable("--junit", *options.junit);
    keep_out_of_caches();
    const StopWhenInterrupted stop;
    something_to_keep();
    std::vector<VariantRow> rows;
    try {
        require_devices(options.required);
        Budget budget(options.budget_s);
        SceneRows run = open_and_verify(keys_of(options), options, {}, {nullptr, nullptr, nullptr, &budget});
        rows = run_variants(run.rows, options, budget);
        deliver_besides_junit(options,
                              variant_report(rows, scene_records(run, options), missing_devices(options), options));
        if (!is_interrupted()) require_variants(rows, options.required);
    } catch (const Error& error) {
        write_junit(rows, options, error.what());
        throw;
    }
    write_junit(rows, options, is_interrupted() ? "the check was interrupted: not all variants ran" : "");
    return is_interrupted() ? end_interrupted_with_result(options) : exit_code(rows);
}

} // namespace tetrace
