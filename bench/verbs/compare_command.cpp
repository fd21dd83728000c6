#include "bench/output/compare_report.h"
#include "bench/show/side_by_side.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"

namespace tetrace {

namespace {

/// Shown, not judged: of several machines or drivers none is the one that must not be slower.
int compare_several(const Options& options)
{
    std::vector<ResultFile> files;
    for (const auto& file : options.files) {
        progress_line().show("reading", static_cast<double>(files.size()) / static_cast<double>(options.files.size()),
                             -1, file.string());
        files.push_back(read_result(file));
    }
    std::vector<ResultComparison> comparisons;
    for (std::size_t i = 1; i < files.size(); ++i)
        comparisons.push_back(compare_results(files.front(), files[i], options.filter, options.tolerance));
    deliver(options, side_by_side(comparisons, options));
    return 0;
}

} // namespace

int compare_command(const Options& options)
{
    if (options.out) check_not_an_input(*options.out, options.files);
    check_output(options);
    if (options.files.size() > 2) return compare_several(options);
    const ResultFile before = read_result(options.files.at(0));
    const ResultFile after = read_result(options.files.at(1));
    const ResultComparison comparison = compare_results(before, after, options.filter, options.tolerance);
    deliver(options, compare_report(comparison, options));
    return comparison.regressions(options.allow_missing).empty() ? 0 : 1;
}

} // namespace tetrace
