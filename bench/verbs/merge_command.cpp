#include "bench/expectations/check_verdict.h"
#include "bench/merging/merged_rows.h"
#include "bench/output/bench_report.h"
#include "bench/output/check_matrix.h"
#include "bench/output/row_fields.h"
#include "bench/show/recorded_rows.h"
#include "bench/show/show_report.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/reproduction.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <optional>

namespace tetrace {

namespace {

using nlohmann::json;
using Shards = std::vector<ShardResult>;

/// A merged result, and how the run that it is of ends: with an exit code, or an error after the report.
struct Merged {
    Report report;
    int code = 0;
    std::optional<Error> error;
};

/// What work() throws.
std::optional<Error> error_of(const std::function<void()>& work)
{
    try {
        work();
    } catch (const Error& error) {
        return error;
    }
    return std::nullopt;
}

/// The options of the whole run; output goes where `merge` says.
Options options_of(const Shards& shards, const Options& asked)
{
    Options options = parse_options(shards.front().arguments);
    options.shard = Shard();
    options.threads = shards.front().section().value("threads", options.threads);
    options.out = asked.out;
    options.format = asked.format;
    options.columns = asked.columns;
    options.junit = asked.junit;
    options.anonymous = options.anonymous || asked.anonymous;
    return options;
}

std::vector<std::string> sentences_of(const Shards& shards, const char* key)
{
    std::vector<std::string> all;
    for (const ShardResult& shard : shards)
        for (const std::string sentence : shard.section().value(key, json::array()))
            if (std::ranges::find(all, sentence) == all.end()) all.push_back(sentence);
    return all;
}

/// As the shards recorded them, with the views of the whole run.
std::vector<json> scenes_of(const Shards& shards, const std::vector<std::uint32_t>& views)
{
    std::vector<json> scenes;
    for (const json& scene : shards.front().section().at("scenes"))
        scenes.emplace_back(scene)["views"] = views;
    return scenes;
}

json head_of(const Shards& shards, const Options& options)
{
    json head = result_head(options);
    set_origin(head, shards);
    return head;
}

Merged merged_bench(const Shards& shards, const Options& options)
{
    BenchResult result;
    result.rows = merged_rows(shards, selected_views(options));
    result.devices = read_devices(shards.front().result, result.rows);
    result.comparisons = compare_rows(result.rows);
    result.best_bvhs = compare_with_best_bvh(result.rows);
    result.scenes = scenes_of(shards, selected_views(options));
    result.missing_scenes = sentences_of(shards, "missing_scenes");
    result.missing_devices = sentences_of(shards, "missing_devices");
    result.threads = options.threads;
    result.conditions = read_steadiness(ResultValue(shards.front().section(), "a shard")).conditions;
    for (const RowRecord& row : result.rows) {
        const auto runs = static_cast<unsigned>(std::max<std::size_t>(row.run_samples.size(), 1));
        result.measurement.runs = std::max(result.measurement.runs, runs);
        const auto samples = static_cast<unsigned>(row.samples_s.size() / runs); // rows that were noisy have more
        unsigned& fewest = result.measurement.samples;
        if (samples > 0) fewest = fewest == 0 ? samples : std::min(fewest, samples);
    }
    const CheckJudgement judgement = judge_answers(result.rows);
    write_junit(result.rows, judgement, options);
    return {bench_report(result, options, head_of(shards, options)), exit_code(result.rows, true), error_of([&] {
                require_judged(result.rows, judgement, options.required);
                require_answers(result.rows, "measured");
            })};
}

Merged merged_check(const Shards& shards, const Options& options)
{
    const std::vector<RowRecord> rows = merged_rows(shards, selected_views(options));
    const auto scenes = scenes_of(shards, selected_views(options));
    const auto missing = sentences_of(shards, "missing_devices");
    json section = head_of(shards, options);
    section["scenes"] = scenes;
    section["matrix"] = matrix_json(rows);
    section["rows"] = json::array();
    for (const RowRecord& row : rows)
        section["rows"].push_back(row_json(check_facts(row)));
    section["missing_devices"] = missing;
    Report report{
        check_sheet({&rows, scenes, missing}), check_table(rows, RunOrigin(ResultValue(section, "the result"))), {}};
    const CheckJudgement judgement = judge_rows(rows, nullptr, options.allow_flawed);
    const auto verdict = verdict_of(rows, judgement, options.required);
    set_verdict(section, verdict);
    if (verdict) report.sheet.append(verdict->line());
    report.json["tetrace"] = std::move(section);
    report.markdown = report.sheet.markdown();
    if (options.out) report.sheet.labelled("Result", options.out->string());
    write_junit(rows, judgement, options);
    return {std::move(report), exit_code(rows, judgement), error_of([&] {
                require_judged(rows, judgement, options.required);
                require_answers(rows, "checked");
            })};
}

/// Throws Error{usage} if another machine than the shards' has other default scenes.
void require_scenes(const std::vector<SceneBuild>& builds, const std::vector<RowRecord>& rows)
{
    for (const RowRecord& row : rows)
        if (std::ranges::none_of(builds, [&](const SceneBuild& build) { return build.label == row.key.scene; }))
            throw Error(ErrorKind::usage,
                        fmt::format("merging shards: they have the scene {}, which is not available here; name the "
                                    "scenes of the run with --scene, or merge where it ran",
                                    row.key.scene));
}

void add_scene(Reproduction& all, const SceneBuild& build, const Options& options, std::vector<RowRecord>& rows,
               Journal& journal)
{
    std::vector<RowRecord> own;
    for (RowRecord& row : rows)
        if (row.key.scene == build.label) own.push_back(std::move(row));
    SceneRun& run = all.runs.emplace_back(recorded_scene_run(build, options, std::move(own)));
    if (build.rivals) SetupCosts(&journal).restore(run.rows);
    run_views(run, options, {&journal, &all.progress});
    run.picture_problems.emplace_back("Pictures are drawn by shards, each of its own views.");
    run.close();
}

Merged merged_reproduction(const Shards& shards, const Options& asked)
{
    Reproduction all;
    const Options options = with_defaults(asked, all.missing_scenes);
    all.missing_scenes = sentences_of(shards, "missing_scenes");
    all.missing_devices = sentences_of(shards, "missing_devices");
    all.devices = read_devices(shards.front().result, {});
    auto builds = scene_builds(options);
    std::vector<RowRecord> rows = rows_of_shards(shards);
    require_scenes(builds, rows);
    std::erase_if(builds, [&](const SceneBuild& build) { return rows_of(build.label, rows).empty(); });
    Journal journal(merged_entries(shards));
    for (const SceneBuild& build : builds)
        add_scene(all, build, options, rows, journal);
    if (const auto searches = rows_of_shards(shards, true); !searches.empty()) {
        SearchRun& run = all.searches.emplace(recorded_search_run(options, searches));
        run_searches(run, options, {&journal, &all.progress});
    }
    make_tables(all, options);
    Report report = reproduction_report(all, options);
    set_origin(report.json["tetrace"], shards);
    const auto merged = all_rows(all);
    write_junit(merged, judge_answers(merged), options);
    return {std::move(report), exit_code(merged, true), error_of([&] { require_answers(merged, "measured"); })};
}

Merged merged_run(const Shards& shards, const Options& options)
{
    if (options.verb == Verb::bench) return merged_bench(shards, options);
    if (options.verb == Verb::check) return merged_check(shards, options);
    return merged_reproduction(shards, options);
}

} // namespace

int merge_command(const Options& asked)
{
    if (asked.out) check_not_an_input(*asked.out, asked.files);
    check_output(asked);
    const Shards shards = read_shards(asked.files);
    const Options options = options_of(shards, asked);
    Merged merged = merged_run(shards, options);
    Sheet more = machines_sheet(merged.report.json["tetrace"]["merged"]);
    merged.report.sheet.append(more);
    if (!merged.report.markdown.empty()) merged.report.markdown += more.markdown();
    deliver_besides_junit(options, merged.report);
    if (merged.error) throw *merged.error;
    return merged.code;
}

} // namespace tetrace
