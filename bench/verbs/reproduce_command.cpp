#include "bench/options/identity.h"
#include "bench/output/bench_report.h"
#include "bench/output/device_json.h"
#include "bench/output/row_json.h"
#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/tables/paper_table.h"
#include "bench/reproduce/tables/pictures.h"
#include "bench/reproduce/tables/recorded_tables.h"
#include "bench/reproduce/tables/tables.h"
#include "bench/reproduce/yardsticks.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/reproduce_builds.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

using nlohmann::json;

/// All data of the result.
struct Reproduction {
    std::vector<SceneRun> runs;
    std::optional<SearchRun> searches;
    json search_records; ///< as results record them; null without searches
    RunProgress progress;

    /// growth: whether those of growth are meant, or those of all other tables.
    [[nodiscard]] SceneRuns runs_of(bool growth) const
    {
        SceneRuns found;
        for (const SceneRun& run : runs)
            if (run.build.growth == growth) found.push_back(&run);
        return found;
    }

    std::vector<RowDevice> devices;
    std::vector<PaperTable> tables;
    std::vector<PaperFigure> figures;
    std::vector<std::string> missing_scenes; ///< one sentence each
};

/// Adds all methods of the paper where none of the CDT is named. Throws Error{usage} where table6 or growth lacks the
/// methods that it needs.
void add_methods(Options& options)
{
    const auto& methods = options.methods;
    const auto is_of_cdt = [](Method method) { return is_method_of(Structure::cdt, method); };
    const bool with_rivals = wants(options, PaperTarget::table6) || wants(options, PaperTarget::growth);
    const bool names_any = std::ranges::any_of(methods, is_of_cdt);
    if (with_rivals && names_any && std::ranges::find(methods, Method::maria) == methods.end())
        throw Error(ErrorKind::usage, "table6 and growth compare maria with BVHs: add it to --method");
    if (names_any || (!methods.empty() && !with_rivals)) return;
    for (const KernelId& kernel : all_kernels())
        if (kernel.structure == Structure::cdt) options.methods.push_back(kernel.method);
}

/// Adds what is not named: all methods of the paper, and its scenes that are available here, else the embedded one.
Options with_defaults(Options options, std::vector<std::string>& missing)
{
    if (options.targets.empty())
        for (const PaperTarget target : values_of<PaperTarget>())
            if (target != PaperTarget::growth) options.targets.push_back(target);
    add_methods(options);
    if (!options.scenes.empty() || !wants_scenes(options)) return options;
    for (const char* const name : {"banana", "bunny", "armadillo"}) {
        const std::string reason = why_not_available(name);
        if (reason.empty())
            options.scenes.emplace_back(name);
        else
            missing.push_back(fmt::format("{} is left out: {}", name, reason));
    }
    if (options.scenes.empty()) options.scenes = {"cubes"};
    return options;
}

std::size_t parts_of(const std::vector<SceneBuild>& builds, const Options& options)
{
    std::size_t parts = wants(options, PaperTarget::table5) ? batch_count(options.searches) : 0;
    for (const SceneBuild& build : builds)
        parts += selected_views(options_of_build(build, options)).size();
    return parts;
}

/// Each device once: all scenes run on the same devices, except those that could not be loaded.
void add_devices(Reproduction& all, const RecordedRows& run, const Options& options, Yardsticks& yardsticks)
{
    auto devices = devices_of(run.rows);
    yardsticks.measure(devices, session_options(options)); // at the first call
    if (devices.size() > all.devices.size()) all.devices = std::move(devices);
}

/// Everything that determines the results of views and searches, and how they are timed.
json journal_head(const Options& options, const std::vector<SceneBuild>& builds)
{
    const BuildIdentity program = build_identity();
    json head = {{"version", program.version},
                 {"commit", program.commit},
                 {"compiler", program.compiler},
                 {"flags", program.flags},
                 {"cpu", host_identity().cpu},
                 {"views", selected_views(options)},
                 {"size", {options.width, options.height}},
                 {"threads", resolved_threads(options)},
                 {"tile", options.tile_height},
                 {"buffer_limit", options.buffer_limit},
                 {"samples", options.samples},
                 {"scenes", json::array()},
                 {"rows", json::array()},
                 {"devices", json::array()}};
    for (const SceneBuild& build : builds) {
        const BuildOptions& how = build.request.build;
        head["scenes"].push_back({{"label", build.label},
                                  {"name", build.request.name},
                                  {"domain", name_of(how.domain)},
                                  {"divisions", how.divisions},
                                  {"tets", name_of(how.tets)},
                                  {"effort", how.effort},
                                  {"switches", how.switches},
                                  {"resolution", how.resolution},
                                  {"views", selected_views(options_of_build(build, options))},
                                  {"robustness", build.robustness},
                                  {"timing", build.timing}});
        for (const RowKey& key : rows_of_build(build, options))
            head["rows"].push_back(row_name(key));
    }
    if (wants(options, PaperTarget::table5)) {
        head["searches"] = {options.searches.tets, options.searches.rays};
        for (const RowKey& key : select_search_rows(options))
            head["rows"].push_back(row_name(key));
    }
    for (const Backend* backend : all_backends()) {
        const auto& named = options.backends;
        if (!named.empty() && std::ranges::find(named, backend->name()) == named.end()) continue; // nor loaded
        for (const Device& device : backend->devices())
            if (device.usable) head["devices"].push_back({backend->name(), device.name, device.driver});
    }
    return head;
}

/// Throws Error{usage} where two scenes would have the same name.
void check_labels(const std::vector<SceneBuild>& builds)
{
    for (std::size_t i = 0; i < builds.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (builds[i].label == builds[j].label)
                throw Error(ErrorKind::usage,
                            fmt::format("--scene: '{}' and '{}' would both be called '{}' in the "
                                        "results; name each scene once",
                                        builds[j].request.name, builds[i].request.name, builds[i].label));
}

std::unique_ptr<Journal> open_journal(const Options& options, const std::vector<SceneBuild>& builds)
{
    if (!options.out) {
        if (options.resume)
            throw Error(ErrorKind::usage,
                        "--resume: the journal is in the result's folder; name the result's file with --out");
        return nullptr;
    }
    return std::make_unique<Journal>(options.out->string() + ".journal", journal_head(options, builds), options.resume);
}

/// Throws Error{usage} where the journal has a line that belongs to none of these builds.
void check_entries(const Journal& journal, const std::vector<SceneBuild>& builds)
{
    const auto is_of_build = [&](const json& entry) {
        return std::ranges::any_of(
            builds, [&](const SceneBuild& build) { return entry.contains("scene") && entry["scene"] == build.label; });
    };
    for (const json& entry : journal.entries())
        if (!entry.contains("batch") && !entry.contains("yardstick") && !entry.contains("setup") && !is_of_build(entry))
            journal.reject(
                "the journal has a line that is of no view of these scenes, no batch, no build and no yardstick");
}

/// Data kept in files next to the result's; null where the result has no file.
struct Keeping {
    Keeping(const Options& options, const std::vector<SceneBuild>& builds)
        : journal(open_journal(options, builds)), yardsticks(journal.get()), costs(journal.get()),
          pictures(options.out ? std::make_unique<ResultPictures>(*options.out) : nullptr)
    {
        if (journal != nullptr) check_entries(*journal, builds);
    }

    std::unique_ptr<Journal> journal;
    Yardsticks yardsticks;
    SetupCosts costs;
    std::unique_ptr<ResultPictures> pictures;
};

void make_tables(Reproduction& all, const Options& options)
{
    const SceneRuns runs = all.runs_of(false);
    const auto add_figures = [&](std::vector<PaperFigure> figures) {
        std::ranges::move(figures, std::back_inserter(all.figures));
    };
    if (wants(options, PaperTarget::table3)) {
        all.tables.push_back(table3(runs));
        all.tables.push_back(table3_rates(runs));
    }
    if (wants(options, PaperTarget::table4)) {
        all.tables.push_back(table4(runs, view_count(options.camera_set)));
        all.figures.push_back(table4_views(runs));
    }
    if (all.searches) {
        all.tables.push_back(table5(*all.searches, all.devices));
        all.tables.push_back(operations_table());
    }
    if (wants(options, PaperTarget::table6)) {
        all.tables.push_back(table6(runs));
        all.tables.push_back(table6_pairs(runs));
        add_figures(table6_figures(runs));
    }
    if (wants(options, PaperTarget::growth)) {
        const SceneRuns sizes = all.runs_of(true);
        all.tables.push_back(growth_table(sizes));
        all.tables.push_back(growth_exponents(sizes));
        add_figures(growth_figures(sizes));
    }
    if (wants(options, PaperTarget::figure6)) {
        all.tables.push_back(figure6_table(runs));
        add_figures(figure6(runs));
    }
}

/// 0 where nothing was timed.
unsigned samples_of(const Reproduction& all, const Options& options)
{
    const bool timed =
        all.searches.has_value() || std::ranges::any_of(all.runs, [](const SceneRun& run) { return run.build.timing; });
    return timed ? options.samples : 0;
}

json reproduction_json(const Reproduction& all, const Options& options)
{
    json section = result_head(options);
    section["threads"] = resolved_threads(options);
    section["samples_a_row"] = samples_of(all, options);
    section["missing_scenes"] = all.missing_scenes;
    section["missing_devices"] = missing_devices(options);
    for (const char* key : {"scenes", "devices", "rows", "tables", "figures"})
        section[key] = json::array();
    for (const SceneRun& run : all.runs) {
        if (run.scene != nullptr) section["scenes"].push_back(scene_json(*run.scene, options));
        if (run.scene != nullptr && run.likeness.kind != LikenessKind::not_its_scene)
            section["scenes"].back()["likeness"] = {{"kind", name_of(run.likeness.kind)},
                                                    {"compared", run.likeness.is_compared()},
                                                    {"reason", run.likeness.reason}};
        section["rows"].insert(section["rows"].end(), run.row_records.begin(), run.row_records.end());
    }
    if (all.searches) section["searches"] = all.search_records;
    for (const RowDevice& device : all.devices)
        section["devices"].push_back(row_device_json(device));
    for (const PaperTable& table : all.tables)
        section["tables"].push_back(table_json(table));
    for (const PaperFigure& figure : all.figures)
        section["figures"].push_back(figure_json(figure));
    return {{"tetrace", std::move(section)}};
}

Report reproduction_report(const Reproduction& all, const Options& options)
{
    Report report{tables_sheet({all.tables, all.figures, all.missing_scenes, missing_devices(options)}),
                  tidy_table(all.tables, all.figures),
                  reproduction_json(all, options),
                  {}};
    for (const PaperTable& table : all.tables)
        report.markdown += table_markdown(table);
    for (const PaperFigure& figure : all.figures)
        report.markdown += figure_markdown(figure);
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

/// Throws Error{missing} as bench and check do where no row of any scene or search could run here.
void require_any_answer(const Reproduction& all)
{
    std::vector<const RowRun*> rows;
    for (const SceneRun& run : all.runs)
        for (const RowRun& row : run.rows)
            rows.push_back(&row);
    if (all.searches)
        for (const RowRun& row : all.searches->rows)
            rows.push_back(&row);
    require_answers(rows, "measured");
}

int rows_exit_code(const Reproduction& all)
{
    int code = all.searches ? exit_code(all.searches->rows, true) : 0;
    for (const SceneRun& run : all.runs)
        code = code == 1 ? code : std::max(code, exit_code(run.rows, true));
    return code;
}

void run_scene(Reproduction& all, const SceneBuild& build, const Options& asked, Keeping& keeping)
{
    const Options options = options_of_build(build, asked);
    SceneRun& run = all.runs.emplace_back(open_scene_run(build, options));
    if (build.rivals || build.growth) run.costs = keeping.costs.of(run.rows);
    run_views(run, options, keeping.journal.get(), all.progress);
    if (keeping.pictures != nullptr && !build.growth)
        keeping.pictures->draw(run, build.robustness, wants(options, PaperTarget::figure6));
    run.close();
    add_devices(all, run, options, keeping.yardsticks);
}

void run_all_searches(Reproduction& all, const Options& options, Keeping& keeping)
{
    SearchRun& run = all.searches.emplace(open_search_run(options));
    run_searches(run, options, keeping.journal.get(), all.progress);
    all.search_records = searches_json(run);
    for (RowRun& row : run.rows)
        row.session.reset();
    add_devices(all, run, options, keeping.yardsticks);
}

} // namespace

int reproduce_command(const Options& asked)
{
    Reproduction all;
    const Options options = with_defaults(asked, all.missing_scenes);
    check_output(options);
    const auto builds = scene_builds(options);
    check_labels(builds);
    Keeping keeping(options, builds);
    for (const std::string& sentence : all.missing_scenes)
        say(sentence);
    all.progress.all = parts_of(builds, options);
    if (keeping.journal != nullptr)
        say_when_interrupted(fmt::format("tetrace: what is finished is in '{}.journal'; to go on: {}",
                                         options.out->string(), command_with("--resume")));
    for (const SceneBuild& build : builds)
        run_scene(all, build, options, keeping);
    if (wants(options, PaperTarget::table5)) run_all_searches(all, options, keeping);
    make_tables(all, options);
    deliver(options, reproduction_report(all, options));
    if (keeping.journal != nullptr) keeping.journal->finish();
    say_when_interrupted({});
    require_any_answer(all);
    return rows_exit_code(all);
}

} // namespace tetrace
