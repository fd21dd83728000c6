#include "bench/debugging/trace_run.h"
#include "bench/measuring/scene_rows.h"
#include "bench/verbs/commands.h"

#include <algorithm>

namespace tetrace {

namespace {

/// The rows that were asked for: not openmp's, where others are named.
std::vector<const RowRecord*> asked_rows(const TraceRun& run)
{
    std::vector<const RowRecord*> asked;
    for (const RowRecord& row : run.rows)
        if (run.rows.size() == 1 || &row != &run.rows.front()) asked.push_back(&row);
    return asked;
}

} // namespace

int trace_command(const Options& options)
{
    check_output(options);
    const TraceRun run = run_trace(options);
    deliver(options, trace_report(run, options));
    require_answers(asked_rows(run), "traced");
    const RayOnDevice* const reference = run.reference();
    if (reference != nullptr &&
        std::ranges::any_of(run.rays, [&](const RayOnDevice& ray) { return differs(ray, *reference); }))
        return exit_code(ErrorKind::wrong_result);
    return exit_code(records_of(run.rows), true);
}

} // namespace tetrace
