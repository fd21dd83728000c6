#include "bench/verbs/reproduction.h"

#include "bench/measuring/scene_rows.h"
#include "bench/output/device_json.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/tables/recorded_tables.h"
#include "bench/reproduce/tables/tables.h"
#include "bench/terminal/interrupts.h"
#include "bench/verbs/commands.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

using nlohmann::json;

/// Adds all methods of the paper where none of the CDT is named. Throws Error{usage} if table6 lacks the
/// methods that it needs.
void add_methods(Options& options)
{
    const auto& methods = options.methods;
    const auto is_of_cdt = [](Method method) { return is_method_of(Structure::cdt, method); };
    const bool with_rivals = wants(options, PaperTarget::table6);
    const bool names_any = std::ranges::any_of(methods, is_of_cdt);
    if (with_rivals && names_any && std::ranges::find(methods, Method::maria) == methods.end())
        throw Error(ErrorKind::usage, "table6 compares maria with BVHs: add it to --method");
    if (names_any || (!methods.empty() && !with_rivals)) return;
    for (const KernelId& kernel : all_kernels())
        if (kernel.structure == Structure::cdt) options.methods.push_back(kernel.method);
}

/// 0 if nothing was timed.
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
    set_steadiness(section, all.steadiness.load, all.steadiness.pulses);
    section["missing_scenes"] = all.missing_scenes;
    section["missing_devices"] = all.missing_devices;
    for (const char* key : {"scenes", "devices", "rows", "tables", "figures"})
        section[key] = json::array();
    for (const SceneRun& run : all.runs) {
        if (run.scene != nullptr) section["scenes"].push_back(scene_json(*run.scene, options));
        if (run.scene != nullptr && run.likeness.kind != LikenessKind::not_its_scene)
            section["scenes"].back()["likeness"] = {{"kind", name_of(run.likeness.kind)},
                                                    {"compared", run.likeness.is_compared()},
                                                    {"reason", run.likeness.reason}};
        for (const RowRecord& row : records_of(run.rows))
            section["rows"].push_back(row_json(RowFacts(row)));
    }
    if (all.searches) section["searches"] = searches_json(*all.searches);
    for (const RowDevice& device : all.devices)
        section["devices"].push_back(row_device_json(device));
    for (const PaperTable& table : all.tables)
        section["tables"].push_back(table_json(table));
    for (const PaperFigure& figure : all.figures)
        section["figures"].push_back(figure_json(figure));
    return {{"tetrace", std::move(section)}};
}

/// Empty if nothing was timed, or no pulse was taken, as by `merge`.
std::string trust_of(const Reproduction& all)
{
    Steadiness steadiness = all.steadiness;
    for (const SceneRun& run : all.runs)
        for (const RowRun& row : run.rows)
            steadiness.count(row);
    if (all.searches)
        for (const RowRun& row : all.searches->rows)
            steadiness.count(row);
    return steadiness.timed == 0 || steadiness.pulses.empty() ? std::string() : trust_text(steadiness);
}

void add_files(Report& report, const Options& options)
{
    if (options.junit && !prints_junit(options)) report.sheet.labelled("JUnit", options.junit->string());
    if (options.out) report.sheet.labelled("Result", options.out->string());
}

} // namespace

Options with_defaults(Options options, std::vector<std::string>& missing)
{
    if (options.targets.empty())
        for (const PaperTarget target : values_of<PaperTarget>())
            if (!is_bench_run(target)) options.targets.push_back(target);
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

void make_tables(Reproduction& all, const Options& options)
{
    SceneRuns runs;
    for (const SceneRun& run : all.runs)
        runs.push_back(&run);
    const auto add_figures = [&](std::vector<PaperFigure> figures) {
        std::ranges::move(figures, std::back_inserter(all.figures));
    };
    if (wants(options, PaperTarget::table3)) {
        all.tables.push_back(table3(runs));
        all.tables.push_back(table3_rates(runs));
    }
    if (wants(options, PaperTarget::table4)) {
        all.tables.push_back(table4(runs, camera_set_size(options)));
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
    if (wants(options, PaperTarget::figure6)) {
        all.tables.push_back(figure6_table(runs));
        add_figures(figure6(runs));
    }
}

Report bench_run_report(const BenchResult& result, const std::vector<PaperTable>& tables,
                        const std::vector<PaperFigure>& figures, const Options& options)
{
    const Steadiness steadiness = steadiness_of(result);
    const PaperTables all = {tables,
                             figures,
                             result.missing_scenes,
                             result.missing_devices,
                             is_timed(result) ? trust_text(steadiness) : std::string(),
                             result.interrupted};
    Report report{tables_sheet(all), tidy_table(tables, figures),
                  bench_report(result, options, result_head(options)).json, tables_markdown(all)};
    for (const PaperTable& table : tables)
        report.json["tetrace"]["tables"].push_back(table_json(table));
    for (const PaperFigure& figure : figures)
        report.json["tetrace"]["figures"].push_back(figure_json(figure));
    add_files(report, options);
    return report;
}

Report reproduction_report(const Reproduction& all, const Options& options)
{
    const PaperTables shown = {all.tables,          all.figures,   all.missing_scenes,
                               all.missing_devices, trust_of(all), is_interrupted()};
    Report report{tables_sheet(shown), tidy_table(all.tables, all.figures), reproduction_json(all, options),
                  tables_markdown(shown)};
    add_files(report, options);
    return report;
}

void judge_steadiness(Reproduction& all, MachineWatch& watch)
{
    all.steadiness = {watch.load(), watch.pulses().found(), host_conditions()};
    for (SceneRun& run : all.runs)
        watch.pulses().judge_rows(run.rows, all.steadiness.load);
    if (all.searches) watch.pulses().judge_rows(all.searches->rows, all.steadiness.load);
}

std::vector<RowRecord> all_rows(const Reproduction& all)
{
    std::vector<RowRecord> rows;
    const auto add = [&](const std::vector<RowRun>& runs) {
        for (const RowRun& row : runs)
            rows.push_back(record_of(row));
    };
    for (const SceneRun& run : all.runs)
        add(run.rows);
    if (all.searches) add(all.searches->rows);
    return rows;
}

namespace {

bool wants_build(const Options& options, PaperBuild build)
{
    const auto& builds = options.paper_builds;
    return builds.empty() || std::ranges::find(builds, build) != builds.end();
}

/// Whether the builder makes its tets: those of cubes, of lattices and of .tet files are their own.
bool is_tetrahedralized(const std::string& name)
{
    return !is_made_in_place(name) && std::filesystem::path(name).extension() != ".tet";
}

/// Whether the scene is one of the paper's, and TetGen makes its tets with the given switches.
bool has_papers_build(const std::string& name)
{
    return paper::has_scene(scene_label(name)) && is_tetrahedralized(name);
}

/// The same scenes in tets for rays, as the options say, and by their own defaults where these say nothing.
std::vector<SceneRequest> requests_for_rays(Options options)
{
    options.tets = {TetsKind::rays};
    return scene_requests(options);
}

SceneBuild papers(SceneBuild build)
{
    BuildOptions& how = build.request.build;
    how.domain = DomainKind::wide;
    how.tets = TetsKind::cdt;
    how.divisions = 1;
    how.switches = paper::nearest_build(build.scene).value().switches;
    build.build = papers_build;
    build.label += "-paper";
    return build;
}

SceneBuild in_rays(SceneBuild build, const SceneRequest& request)
{
    build.request = request;
    build.build = rays_build;
    build.label += "-rays";
    return build;
}

} // namespace

bool wants(const Options& options, PaperTarget target)
{
    return std::ranges::find(options.targets, target) != options.targets.end();
}

bool wants_scenes(const Options& options)
{
    const auto& targets = options.targets;
    return std::ranges::any_of(targets, [](PaperTarget target) { return target != PaperTarget::table5; });
}

std::vector<SceneBuild> scene_builds(const Options& options)
{
    const bool table3 = wants(options, PaperTarget::table3), table6 = wants(options, PaperTarget::table6);
    const bool table4 = wants(options, PaperTarget::table4), figure6 = wants(options, PaperTarget::figure6);
    std::vector<SceneBuild> builds;
    if (!wants_scenes(options)) return builds;
    const auto requests = scene_requests(options), of_rays = requests_for_rays(options);
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const std::string& name = requests[i].name;
        const std::string label = scene_label(name);
        const SceneBuild ours = {
            requests[i], label, our_build, label, table4, table3 || table6 || figure6, table3 || table4 || figure6,
            table6};
        const bool papers_too = wants_build(options, PaperBuild::paper) && has_papers_build(name);
        const bool rays_too = wants_build(options, PaperBuild::rays) && is_tetrahedralized(name);
        const bool has_all = !wants_build(options, PaperBuild::paper) || papers_too;
        if (wants_build(options, PaperBuild::ours) || !has_all || (!papers_too && !rays_too)) builds.push_back(ours);
        if (papers_too) builds.push_back(papers(ours));
        if (rays_too) builds.push_back(in_rays(ours, of_rays[i]));
    }
    return builds;
}

} // namespace tetrace
