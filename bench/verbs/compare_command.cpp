#include "bench/output/compare_report.h"
#include "bench/verbs/commands.h"

namespace tetrace {

int compare_command(const Options& options)
{
    if (options.out) check_not_an_input(*options.out, options.files);
    check_output(options);
    const ResultFile before = read_result(options.files.at(0));
    const ResultFile after = read_result(options.files.at(1));
    const ResultComparison comparison = compare_results(before, after, options.filter, options.tolerance);
    deliver(options, compare_report(comparison, options));
    return comparison.regressions(options.allow_missing).empty() ? 0 : 1;
}

} // namespace tetrace
