#include "bench/measuring/run_journal.h"
#include "bench/reproduce/kept_costs.h"
#include "bench/reproduce/tables/ladder.h"
#include "bench/reproduce/tables/pictures.h"
#include "bench/rivals/rival_run.h"
#include "bench/rows/sized_scene.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/ladder.h"
#include "bench/verbs/reproduction.h"
#include "bench/verbs/volume.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

/// Those with rows; none if the shard is without views.
std::vector<SceneBuild> builds_of_shard(const Options& options)
{
    if (selected_views(options).empty()) return {};
    auto builds = scene_builds(options);
    check_labels(builds);
    std::erase_if(builds, [&](const SceneBuild& build) { return rows_of_build(build, options).empty(); });
    return builds;
}

bool searches_of_shard(const Options& options)
{
    return wants(options, PaperTarget::table5) && shard_of(options).share(batch_count(options.searches)) > 0 &&
           !select_search_rows(options).empty();
}

std::size_t parts_of(const std::vector<SceneBuild>& builds, const Options& options, bool searches)
{
    return builds.size() * selected_views(options).size() +
           (searches ? shard_of(options).share(batch_count(options.searches)) : 0);
}

/// Each device once: all scenes run on the same devices, except those that could not be loaded.
void add_devices(Reproduction& all, const RecordedRows& run, const Options& options, Yardsticks& yardsticks)
{
    auto devices = devices_of(records_of(run.rows));
    if (!is_interrupted()) yardsticks.measure(devices, session_options(options)); // at the first call
    if (devices.size() > all.devices.size()) all.devices = std::move(devices);
}

std::vector<RowKey> rows_of_run(const std::vector<SceneBuild>& builds, const Options& options)
{
    std::vector<RowKey> rows;
    for (const SceneBuild& build : builds)
        std::ranges::move(rows_of_build(build, options), std::back_inserter(rows));
    if (wants(options, PaperTarget::table5)) std::ranges::move(select_search_rows(options), std::back_inserter(rows));
    return rows;
}

json journal_head(const Options& options, const std::vector<SceneBuild>& builds)
{
    json scenes = json::array();
    for (const SceneBuild& build : builds) {
        scenes.push_back(scene_head(build.request, build.label));
        scenes.back()["robustness"] = build.robustness;
        scenes.back()["timing"] = build.timing;
    }
    json head = run_head(options, rows_of_run(builds, options));
    head["scenes"] = std::move(scenes);
    if (wants(options, PaperTarget::table5)) head["searches"] = {options.searches.tets, options.searches.rays};
    return head;
}

/// Throws Error{usage} if the journal has a line that belongs to none of these builds.
void check_entries(const Journal& journal, const std::vector<SceneBuild>& builds)
{
    const auto is_of_build = [&](const json& entry) {
        return std::ranges::any_of(
            builds, [&](const SceneBuild& build) { return entry.contains("scene") && entry["scene"] == build.label; });
    };
    for (const json& entry : journal.entries())
        if (!entry.contains("batch") && !entry.contains("yardstick") && !entry.contains("setup") && !is_of_build(entry))
            journal.reject("the journal has an entry that does not belong to this run");
}

/// Data kept in files next to the result's; null without a result file.
struct Keeping {
    Keeping(const Options& options, const std::vector<SceneBuild>& builds)
        : journal(open_journal(options, journal_head(options, builds))), yardsticks(journal.get()),
          costs(journal.get()), watch(watch_of(host_pulse(resolved_threads(options)), journal.get())),
          pictures(options.out ? std::make_unique<ResultPictures>(*options.out) : nullptr)
    {
        if (journal == nullptr) return;
        check_entries(*journal, builds);
        say_how_to_go_on(options);
    }

    std::unique_ptr<Journal> journal;
    Yardsticks yardsticks;
    SetupCosts costs;
    MachineWatch watch;
    std::unique_ptr<ResultPictures> pictures;
};

/// A share of the run's budget.
Budget share_of_budget(double share_s, const Options& options)
{
    return Budget(share_s, host_clock(), std::isinf(share_s) ? 1 : options.budget_s / share_s);
}

/// budget_s: of this scene.
void run_scene(Reproduction& all, const SceneBuild& build, const Options& options, Keeping& keeping, double budget_s)
{
    SceneRun& run = all.runs.emplace_back(open_scene_run(build, options));
    if (build.rivals) keeping.costs.restore(run.rows);
    Budget budget = share_of_budget(budget_s, options);
    run_views(run, options, {keeping.journal.get(), &all.progress, &keeping.watch, &budget});
    if (keeping.pictures != nullptr)
        keeping.pictures->draw(run, build.robustness, wants(options, PaperTarget::figure6));
    run.close();
    add_devices(all, run, options, keeping.yardsticks);
}

void run_all_searches(Reproduction& all, const Options& options, Keeping& keeping, double budget_s)
{
    SearchRun& run = all.searches.emplace(open_search_run(options));
    Budget budget = share_of_budget(budget_s, options);
    run_searches(run, options, {keeping.journal.get(), &all.progress, &keeping.watch, &budget});
    for (RowRun& row : run.rows)
        row.session.reset();
    add_devices(all, run, options, keeping.yardsticks);
}

/// The rows that there would be without --filter.
std::vector<RowKey> unfiltered_rows_of_run(Options options)
{
    options.filter.clear();
    return rows_of_run(scene_builds(options), options);
}

/// What a run measured, also if it then ends early.
struct JudgedRows {
    std::vector<RowRecord> rows;
    CheckJudgement judgement;

    void set(std::vector<RowRecord> measured)
    {
        rows = std::move(measured);
        judgement = judge_answers(rows);
    }
    /// Of a run that did not end early.
    [[nodiscard]] int exit_code(const Options& options) const
    {
        require_judged(rows, judgement, options.required);
        require_answers(rows, "measured");
        return tetrace::exit_code(rows, true);
    }
};

/// Once the result is delivered: the exit code. journal: ends, unless the run can go on.
int end_run(bool interrupted, Journal* journal, const Options& options, const JudgedRows& judged)
{
    if (interrupted) return end_interrupted();
    end_journal(journal, options);
    return judged.exit_code(options);
}

/// A run of `bench` over the scenes and rows of the claims, which are then judged.
int reproduce_rivals(const Options& asked, JudgedRows& judged)
{
    check_output(asked);
    std::vector<std::string> missing;
    require_devices(asked.required);
    const Options options = rival_options(asked, missing);
    for (const std::string& sentence : missing)
        say(sentence);
    const auto rows = rival_rows(options);
    require_selected(rows, options);
    const auto journal = open_journal(options, run_head(options, rows));
    BenchResult result = run_bench(rows, options, read_benchmark_flags({}), journal.get());
    result.missing_scenes = missing;
    const auto tables = rival_tables(result.rows, contest_scenes(result.scenes), left_out(options));
    judged.set(result.rows);
    deliver_besides_junit(options, bench_run_report(result, tables, {}, options));
    return end_run(result.interrupted, journal.get(), options, judged);
}

/// A run of `bench` for each scene, smallest first, and rays alone.
int reproduce_ladder(const Options& asked, JudgedRows& judged)
{
    check_output(asked);
    require_devices(asked.required);
    const Options options = ladder_options(asked);
    const auto rows = select_rows(options, scene_labels(options));
    require_selected(rows, options);
    const auto journal = open_journal(options, run_head(options, rows));
    if (journal != nullptr) say_how_to_go_on(options);
    KeptParts kept(journal.get(), options);
    const Ladder ladder = run_ladder(options, rows, kept);
    judged.set(ladder.result.rows);
    deliver_besides_junit(options, bench_run_report(ladder.result, {ladder_table(ladder.result.rows, ladder.costs)},
                                                    ladder_figures(ladder.result.rows, ladder.costs), options));
    return end_run(ladder.result.interrupted, journal.get(), options, judged);
}

/// A run of `bench` for each scene and task that crosses tets.
int reproduce_volume(const Options& asked, JudgedRows& judged)
{
    check_output(asked);
    require_devices(asked.required);
    const Options options = volume_options(asked);
    std::vector<std::string> missing;
    const auto scenes = volume_scenes(options, missing);
    for (const std::string& sentence : missing)
        say(sentence);
    const auto journal = open_journal(options, volume_head(options, scenes));
    if (journal != nullptr) say_how_to_go_on(options);
    KeptParts kept(journal.get(), options);
    Volume volume = run_volume(options, scenes, kept);
    auto& left_out = volume.result.missing_scenes;
    left_out.insert(left_out.begin(), missing.begin(), missing.end());
    complete(volume.result, options);
    judged.set(volume.result.rows);
    deliver_besides_junit(asked, bench_run_report(volume.result,
                                                  {volume_table(volume.result.rows), volume_lines_table(volume.lines)},
                                                  {}, asked));
    return end_run(volume.result.interrupted, journal.get(), options, judged);
}

int reproduce_paper(const Options& asked, JudgedRows& judged)
{
    require_devices(asked.required);
    Reproduction all;
    const Options options = with_defaults(asked, all.missing_scenes);
    check_output(options);
    const auto builds = builds_of_shard(options);
    const bool searches = searches_of_shard(options);
    if (builds.empty() && !searches && !options.filter.empty())
        require_rows(options, {}, unfiltered_rows_of_run(options));
    if (builds.empty() && !searches)
        throw Error(ErrorKind::usage, fmt::format("--shard {}: this shard would be empty: neither a view nor a "
                                                  "batch of searches",
                                                  text_of(shard_of(options))));
    if (!options.required.empty()) require_selected(rows_of_run(builds, options), options);
    all.missing_devices = missing_devices(options);
    Keeping keeping(options, builds);
    for (const std::string& sentence : all.missing_scenes)
        say(sentence);
    all.progress.all = parts_of(builds, options, searches);
    double left_s = options.budget_s;
    std::size_t shares = builds.size() + (searches ? 1 : 0);
    for (const SceneBuild& build : builds) {
        if (is_interrupted()) break;
        const Stopwatch watch;
        run_scene(all, build, options, keeping, left_s / static_cast<double>(shares--));
        left_s = std::max(1.0, left_s - watch.seconds());
    }
    if (searches && !is_interrupted()) run_all_searches(all, options, keeping, left_s);
    judge_steadiness(all, keeping.watch);
    make_tables(all, options);
    judged.set(all_rows(all));
    deliver_besides_junit(options, reproduction_report(all, options));
    return end_run(is_interrupted(), keeping.journal.get(), options, judged);
}

} // namespace

int reproduce_command(const Options& options)
{
    const StopWhenInterrupted stop;
    JudgedRows judged;
    return with_junit(judged.rows, judged.judgement, options, [&] {
        if (wants(options, PaperTarget::volume)) return reproduce_volume(options, judged);
        if (wants(options, PaperTarget::ladder)) return reproduce_ladder(options, judged);
        return wants(options, PaperTarget::rivals) ? reproduce_rivals(options, judged)
                                                   : reproduce_paper(options, judged);
    });
}

} // namespace tetrace
