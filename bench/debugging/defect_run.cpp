#include "bench/debugging/defect_run.h"

#include "bench/rows/rows.h"
#include "bench/terminal/progress.h"
#include "core/base/printable.h"
#include "core/base/stopwatch.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

void judge(DefectRun& run, const std::vector<std::uint32_t>& words)
{
    run.wrong = wrong_items(*run.defect, words);
    if (run.wrong.empty()) return;
    run.sight = DefectSight::seen;
    if (run.wrong.front() < words.size()) run.first_word = words[run.wrong.front()];
}

void run_on(DefectRun& run, Backend& runner)
{
    const Stopwatch watch;
    try {
        judge(run, runner.run_defect(run.device_index, run.defect->name));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        run.sight = DefectSight::error;
        run.kind = error.kind();
        run.reason = printable_text(error.what());
    } catch (const std::exception& error) {
        run.sight = DefectSight::error;
        run.reason = printable_text(error.what());
    }
    run.seconds = watch.seconds();
}

/// The devices of the rows that the options select, each once, as a row's key names them.
std::vector<RowKey> places(const Options& options, const std::vector<Backend*>& backends)
{
    std::vector<RowKey> found;
    for (const RowKey& key : select_rows(options, {"defects"}, backends)) {
        const auto is_there = [&](const RowKey& other) {
            return other.backend == key.backend && other.device == key.device;
        };
        if (std::ranges::none_of(found, is_there)) found.push_back(key);
    }
    return found;
}

} // namespace

std::vector<DefectRun> run_defects(const Options& options, const std::vector<Backend*>& backends)
{
    std::vector<DefectRun> runs;
    for (const RowKey& place : places(options, backends)) {
        Backend& backend = **std::ranges::find(backends, place.backend, &Backend::name);
        if (!backend.runs_defects()) continue; // Embree compiles nothing
        for (const Defect& defect : all_defects()) {
            DefectRun& run = runs.emplace_back();
            run.backend = place.backend;
            run.device_index = place.device;
            run.device = backend.devices().at(place.device);
            run.defect = &defect;
            if (run.device.usable) {
                progress_line().show("running reduced kernels", -1, -1, run.device.name);
                run_on(run, backend);
                continue;
            }
            run.sight = run.device.broken ? DefectSight::error : DefectSight::skipped;
            run.kind = run.device.broken ? ErrorKind::driver : ErrorKind::missing;
            run.reason = run.device.reason;
        }
    }
    progress_line().clear();
    return runs;
}

int exit_code(const std::vector<DefectRun>& runs)
{
    const auto has = [&](DefectSight sight) { return std::ranges::find(runs, sight, &DefectRun::sight) != runs.end(); };
    if (has(DefectSight::seen)) return exit_code(ErrorKind::wrong_result);
    for (const DefectRun& run : runs)
        if (run.sight == DefectSight::error) return exit_code(run.kind);
    return has(DefectSight::not_seen) ? 0 : exit_code(ErrorKind::missing);
}

} // namespace tetrace
