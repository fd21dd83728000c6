#include "bench/debugging/defect_report.h"
#include "bench/expectations/expectation_files.h"
#include "bench/options/identity.h"
#include "bench/rows/rows.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "core/base/files.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

void write_junit(const std::vector<DefectRun>& runs, const Options& options, const std::string& problem = {})
{
    if (!options.junit) return;
    std::string xml = defect_junit(runs, problem);
    if (options.anonymous) xml = anonymous_text(xml, options);
    if (prints_junit(options))
        print(xml);
    else
        write_whole(*options.junit, xml);
}

/// A required backend has not been checked where none of its devices was asked.
void require_run(const std::vector<DefectRun>& runs, const std::vector<std::string>& backends)
{
    for (const std::string& name : backends)
        if (!has_run_on(name, runs))
            throw Error(ErrorKind::missing, fmt::format("--require {0}: no kernel of the check ran on {0}", name));
}

} // namespace

int check_defects(const Options& options)
{
    check_output(options);
    if (options.junit && !prints_junit(options)) check_writable("--junit", *options.junit);
    std::optional<Expectations> given;
    if (!options.expected.empty()) given = read_expectations(options.expected);
    const Expectations* const expectations = given ? &*given : nullptr;
    std::optional<ExpectationTarget> target;
    if (options.write_expected) target.emplace(*options.write_expected);
    std::vector<DefectRun> runs;
    try {
        require_devices(options.required);
        runs = run_defects(options, all_backends(), expectations);
        std::vector<std::filesystem::path> written;
        if (target) written = target->write(expectations_of(runs));
        deliver_besides_junit(options, defect_report(runs, missing_devices(options), options, expectations, written));
        require_run(runs, options.required);
    } catch (const Error& error) {
        write_junit(runs, options, error.what());
        throw;
    }
    write_junit(runs, options);
    return exit_code(runs);
}

} // namespace tetrace
