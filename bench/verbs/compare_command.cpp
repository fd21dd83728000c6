#include "bench/output/compare_report.h"
#include "bench/show/check_comparison.h"
#include "bench/show/side_by_side.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// Both of two, or none: a check has verdicts, and no times, which a tolerance is of.
bool are_checks(const std::vector<ResultFile>& files, const Options& options)
{
    const auto checks = std::ranges::count_if(files, is_check);
    if (checks == 0) return false;
    if (checks < std::ssize(files) || files.size() > 2) {
        const auto check = std::ranges::find_if(files, is_check);
        throw Error(ErrorKind::invalid_input,
                    fmt::format("comparing: '{}' is of 'tetrace check', which has verdicts and no times; compare two "
                                "checks with each other",
                                check->path.string()));
    }
    if (options.tolerance != Options{}.tolerance)
        throw Error(ErrorKind::usage, "--tolerance is a difference in time, and a check has no times; leave it out");
    return true;
}

int compare_two_checks(const std::vector<ResultFile>& files, const Options& options)
{
    const CheckComparison comparison = compare_checks(files[0], files[1], options.filter);
    deliver(options, check_comparison_report(comparison, options));
    return comparison.regressions(options.allow_missing).empty() ? 0 : 1;
}

/// Shown, not judged: of several machines or drivers none is the one that must not be slower.
int compare_several(const std::vector<ResultFile>& files, const Options& options)
{
    std::vector<ResultComparison> comparisons;
    for (std::size_t i = 1; i < files.size(); ++i)
        comparisons.push_back(compare_results(files.front(), files[i], options.filter, options.tolerance));
    deliver(options, side_by_side(comparisons, options));
    return 0;
}

std::vector<ResultFile> read_results(const std::vector<std::filesystem::path>& paths)
{
    std::vector<ResultFile> files;
    for (const auto& path : paths) {
        progress_line().show("reading", static_cast<double>(files.size()) / static_cast<double>(paths.size()), -1,
                             path.string());
        files.push_back(read_result(path));
    }
    return files;
}

} // namespace

int compare_command(const Options& options)
{
    if (options.out) check_not_an_input(*options.out, options.files);
    check_output(options);
    const std::vector<ResultFile> files = read_results(options.files);
    if (are_checks(files, options)) return compare_two_checks(files, options);
    if (files.size() > 2) return compare_several(files, options);
    const ResultComparison comparison = compare_results(files[0], files[1], options.filter, options.tolerance);
    deliver(options, compare_report(comparison, options));
    return comparison.regressions(options.allow_missing).empty() ? 0 : 1;
}

} // namespace tetrace
