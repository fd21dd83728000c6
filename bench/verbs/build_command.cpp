#include "bench/measuring/figures.h"
#include "bench/measuring/scene_rows.h"
#include "bench/output/report.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "scenes/export_tets.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace tetrace {

namespace {

/// A combination and its result.
struct Built {
    SceneRequest request;
    std::optional<nlohmann::json> scene; ///< empty if it failed
    TetMeshCounts counts;
    std::string switches;    ///< as passed; empty where TetGen did not run
    OptimisedInfo optimised; ///< what the optimiser of tets did
    std::uint64_t bytes = 0;
    double build_s = 0;
    bool from_cache = false;
    bool interrupted = false; ///< Ctrl-C came while it was built
    BoundingSphere sphere;    ///< of the mesh, in its file's coordinates
    RayTotals totals;
    std::optional<Error> failure; ///< why it failed
};

template <class T>
std::vector<T> values(const std::vector<T>& given, const T& otherwise)
{
    return given.empty() ? std::vector<T>{otherwise} : given;
}

std::vector<SceneRequest> combinations(const Options& options)
{
    std::vector<SceneRequest> requests;
    for (SceneRequest request : scene_requests(options))
        for (const TetsKind tets : options.tets) {
            const BuildOptions usual = default_build(tets);
            for (const DomainKind domain : options.domains)
                for (const std::uint32_t divisions : values(options.divisions, usual.divisions))
                    for (const std::string& switches : values(options.switches, usual.switches)) {
                        request.build.tets = tets;
                        request.build.domain = domain;
                        request.build.divisions = divisions;
                        request.build.switches = switches;
                        requests.push_back(request);
                    }
        }
    return requests;
}

/// The kernel whose walk counts the steps: the first that openmp has. The number of steps depends only on the mesh.
RowKey counting_row(const Options& options, const std::string& label)
{
    Options selection = options;
    selection.structures = {Structure::cdt};
    selection.backends = {reference_backend().name()};
    return select_rows(selection, {label}).front();
}

void count_steps(Built& built, SceneWork& scene, const Options& options)
{
    RowRun row = open_row(counting_row(options, scene.label()), scene, options);
    if (row.session == nullptr) throw Error(ErrorKind::unsupported, "counting steps: " + reason_of(row));
    std::vector<Hit> hits(scene.rays_per_view());
    for (std::size_t view = 0; view < scene.views().size(); ++view) {
        progress_line().show("counting steps, " + scene.label(),
                             static_cast<double>(view) / static_cast<double>(scene.views().size()));
        static_cast<void>(row.session->trace(scene.job(view, &row.packed->data, row.device), hits));
        built.totals.add(count_rays(hits));
    }
    built.bytes = row.session->bytes();
}

/// tets: a file for them, or empty.
Built build_one(const SceneRequest& request, const Options& options, const std::optional<std::filesystem::path>& tets)
{
    Built built;
    built.request = request;
    try {
        SceneWork scene = load_work(request, options);
        built.counts = scene.counts();
        built.switches = scene.loaded().scene.build.switches;
        built.optimised = scene.loaded().scene.build.optimised;
        built.build_s = scene.loaded().scene.build.build_s;
        built.from_cache = scene.loaded().from_cache;
        built.interrupted = scene.loaded().interrupted;
        built.request.build.divisions = scene.loaded().scene.domain.divisions;
        built.request.build.domain = scene.loaded().scene.domain.kind;
        built.sphere = source_sphere(scene.loaded().scene);
        if (tets) export_tets(scene.loaded().scene, *tets);
        count_steps(built, scene, options);
        built.scene = scene_json(scene, options);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted || error.kind() == ErrorKind::usage) throw;
        built.failure = error;
    }
    return built;
}

/// Of the tets that rays from outside reach; the others are inside closed objects.
double reached_bytes(const Built& built)
{
    return static_cast<double>(built.bytes) * static_cast<double>(built.counts.reached_tets) /
           static_cast<double>(built.counts.tets);
}

std::vector<Cell> table_row(const Built& built)
{
    const bool good = built.scene.has_value();
    const MeanSteps mean = mean_steps(built.totals);
    const auto count = [&](std::uint64_t value) { return good ? Cell(value) : Cell(); };
    const double hits_percent = 100.0 * static_cast<double>(built.totals.hits) / static_cast<double>(built.totals.rays);
    const OptimisedInfo& optimised = built.optimised;
    const auto cost = [&](double value) { return good && value > 0 ? Cell(value) : Cell(); };
    return {scene_label(built.request.name),
            std::string(name_of(good ? optimised.tets : built.request.build.tets)),
            std::string(name_of(built.request.build.domain)),
            std::uint64_t{built.request.build.divisions},
            good && built.switches.empty() ? Cell() : Cell(good ? built.switches : built.request.build.switches),
            count(built.counts.tets),
            count(built.counts.occlusive_faces),
            count(built.counts.free_faces),
            good ? Cell(1e-6 * static_cast<double>(built.bytes)) : Cell(),
            good ? Cell(1e-6 * reached_bytes(built)) : Cell(),
            good && built.build_s > 0 ? Cell(built.build_s) : Cell(), // else the tets were stored
            cost(optimised.seconds),
            cost(optimised.cost_before),
            cost(optimised.cost_after),
            good ? Cell(std::string(built.from_cache ? "yes" : "no")) : Cell(),
            cell_of(mean.all),
            cell_of(mean.hit),
            cell_of(mean.miss),
            good ? Cell(hits_percent) : Cell(),
            built.totals.lost > 0 ? Cell(built.totals.lost) : Cell(),
            good ? Cell() : Cell(built.failure->what())};
}

std::vector<Column> columns(bool with_reason)
{
    std::vector<Column> list = {{"scene", "scene"},
                                {"tets_kind", "kind"},
                                {"domain", "domain"},
                                {"divisions", "n"},
                                {"switches", "switches"},
                                {"tets", "tets"},
                                {"occlusive_faces", "occlusive"},
                                {"free_faces", "free"},
                                {"size_mb", "size", "MB", 1},
                                {"reached_mb", "reached", "MB", 1},
                                {"build_s", "build", "s", 1},
                                {"optimise_s", "optimise", "s", 1},
                                {"cost_before", "cost", "before"},
                                {"cost_after", "cost", "after"},
                                {"from_cache", "cached"},
                                {"mean_steps", "steps", "per ray"},
                                {"mean_steps_hit", "steps", "per hit"},
                                {"mean_steps_miss", "steps", "per miss"},
                                {"hits_percent", "hits", "%", 1},
                                {"lost", "lost", "rays"}};
    if (with_reason) list.push_back({"reason", "reason"});
    return list;
}

Table build_table(const std::vector<Built>& all, bool with_reason)
{
    Table table(columns(with_reason));
    for (const Built& built : all) {
        auto row = table_row(built);
        if (!with_reason) row.pop_back();
        table.add(std::move(row));
    }
    return table;
}

/// Reasons are too long for a column on a terminal. Each is said as soon as it is known, and once a scene.
void tell_failure(const std::vector<Built>& all)
{
    const Built& built = all.back();
    if (!built.failure) return;
    const std::string reason = built.failure->what();
    const bool is_told = std::any_of(all.begin(), all.end() - 1, [&](const Built& other) {
        return other.failure && other.request.name == built.request.name && other.failure->what() == reason;
    });
    const BuildOptions& how = built.request.build;
    say(fmt::format("{} ({}, {}, {}, {}) failed{}", scene_label(built.request.name), name_of(how.tets),
                    name_of(how.domain), how.divisions, how.switches,
                    is_told ? " for the same reason" : ": " + reason));
}

/// As that of rows: 1 where rays are lost, else that of the first failure, else 0.
int exit_code(const std::vector<Built>& all)
{
    int code = 0;
    for (const Built& built : all) {
        if (built.totals.lost > 0) return 1;
        if (code == 0 && built.failure) code = exit_code(built.failure->kind());
    }
    return code;
}

/// The same scene in the same domain as TetGen's CDT, if it was built too; else null.
const Built* find_cdt(const std::vector<Built>& all, const Built& rays)
{
    for (const Built& built : all)
        if (built.scene && built.request.name == rays.request.name && built.optimised.tets == TetsKind::cdt &&
            built.request.build.domain == rays.request.build.domain)
            return &built;
    return nullptr;
}

/// Cost and steps before and after the optimiser, and what each of its operations did.
void add_optimiser(Sheet& sheet, const std::vector<Built>& all, const Built& built)
{
    const OptimisedInfo& made = built.optimised;
    if (made.operations.empty()) return;
    std::string steps;
    if (const Built* cdt = find_cdt(all, built))
        steps = fmt::format("; steps per ray {:.2f} in the CDT, {:.2f} now", mean_steps(cdt->totals).all.value_or(0),
                            mean_steps(built.totals).all.value_or(0));
    Table table({{"operation", "operation"},
                 {"done", "done"},
                 {"gain", "cost", "lowered by"},
                 {"share", "share", "%", 1},
                 {"seconds", "time", "s", 1}});
    for (const OptimiserOperation& operation : made.operations)
        table.add({operation.name, operation.done, operation.gain,
                   100 * operation.gain / (made.cost_before - made.cost_after), operation.seconds});
    const std::string early =
        made.end == OptimiserEnd::finished ? "" : fmt::format(", stopped early ({})", name_of(made.end));
    sheet.gap();
    sheet.heading(fmt::format("{} ({}, {}), the optimiser in {} rounds{}: cost {:.2f} before, {:.2f} after{}",
                              scene_label(built.request.name), name_of(built.request.build.domain),
                              built.request.build.divisions, made.rounds, early, made.cost_before, made.cost_after,
                              steps));
    sheet.gap();
    sheet.table(table);
}

/// What cameras refer to, once a scene.
void add_spheres(Sheet& sheet, const std::vector<Built>& all)
{
    std::set<std::string> said;
    for (const Built& built : all)
        if (built.scene && said.insert(built.request.name).second) {
            const BoundingSphere& sphere = built.sphere;
            sheet.line(fmt::format(
                "{}: cameras are placed in radii of {:.9g} from its centre, ({:.9g}, {:.9g}, {:.9g}), "
                "in the mesh's coordinates.",
                scene_label(built.request.name), sphere.radius, sphere.centre.x, sphere.centre.y, sphere.centre.z));
        }
}

Report build_report(const std::vector<Built>& all, const Options& options)
{
    nlohmann::json section = result_head(options);
    const Table full = build_table(all, true);
    section["builds"] = to_json(full);
    for (std::size_t i = 0; i < all.size(); ++i) {
        section["builds"][i]["status"] = all[i].scene ? "ok" : "error";
        if (all[i].scene) section["builds"][i]["scene_record"] = *all[i].scene;
    }
    Sheet sheet;
    sheet.table(build_table(all, false), 0);
    for (const Built& built : all)
        add_optimiser(sheet, all, built);
    sheet.gap();
    add_spheres(sheet, all);
    sheet.line(fmt::format(
        "Steps of primary rays: {} views of {} at {}x{}. Cost: free faces outside the objects (of a file of tets, "
        "inside too) that a uniform line crosses, before and after optimising. Reached: what rays from outside can "
        "load; the rest is "
        "inside closed objects.",
        selected_views(options).size(), camera_set_name(options), options.width, options.height));
    return {std::move(sheet), full, {{"tetrace", std::move(section)}}};
}

} // namespace

namespace {

/// The file of --out if it is one of tets; the result has none then.
std::optional<std::filesystem::path> take_tets_file(Options& options, std::size_t scenes)
{
    if (!options.out || !is_tets_file(*options.out)) return {};
    if (scenes != 1)
        throw Error(ErrorKind::usage,
                    fmt::format("--out: '{}' is a file of the tets of one scene, and {} are asked for; name one "
                                "--scene, and one value each of --tets, --domain, --divisions and --switches",
                                options.out->string(), scenes));
    check_writable("--out", *options.out);
    return std::exchange(options.out, std::nullopt);
}

} // namespace

int build_command(const Options& asked)
{
    Options options = asked;
    const std::vector<SceneRequest> requests = combinations(options);
    const auto tets = take_tets_file(options, requests.size());
    check_output(options);
    for (const std::string& sentence : missing_default_scenes(options))
        say(sentence);
    std::vector<Built> all;
    bool interrupted = false;
    for (const SceneRequest& request : requests) {
        if (interrupted) break;
        all.push_back(build_one(request, options, tets));
        tell_failure(all);
        interrupted = all.back().interrupted;
    }
    deliver(options, build_report(all, options));
    if (interrupted) throw Error(ErrorKind::interrupted, "building scenes: interrupted; what follows was not built");
    return exit_code(all);
}

} // namespace tetrace
