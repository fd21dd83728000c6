#include "bench/bench_report.h"
#include "bench/commands.h"
#include "bench/progress.h"
#include "bench/row_json.h"
#include "bench/text.h"
#include "bench/walk_path.h"
#include "core/hash.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

Table check_table(const std::vector<RowRun>& rows)
{
    Table table({{"name", "row"},
                 {"rays", "rays"},
                 {"agreed", "agreed"},
                 {"ties", "ties"},
                 {"largest_tie_distance", "largest", {}, 12},
                 {"settled", "settled"},
                 {"wrong", "wrong"},
                 {"lost", "lost"},
                 {"different_from_openmp", "differ"},
                 {"hit_hash", "hits"},
                 {"status", "status"},
                 {"reason", "reason"}});
    for (const RowRun& row : rows) {
        const Traced* result = traced(row);
        const auto count = [&](std::uint64_t Verdicts::*member) {
            return result ? Cell(result->verdicts.*member) : Cell();
        };
        const std::string reason = reason_of(row);
        table.add({row_name(row.key), count(&Verdicts::rays), count(&Verdicts::agreed), count(&Verdicts::ties),
                   result && result->verdicts.ties > 0 ? Cell(result->verdicts.largest_tie_distance) : Cell(),
                   count(&Verdicts::settled), count(&Verdicts::wrong), count(&Verdicts::lost),
                   result && result->compared ? Cell(result->different) : Cell(),
                   result ? Cell(hash_text(result->hit_hash)) : Cell(), std::string(name_of(status_of(row))),
                   reason.empty() ? Cell() : Cell(reason)});
    }
    return table;
}

/// For people: the row's name is given in parts, and what is the same everywhere is left to the other forms.
std::string scene_text(const SceneWork& scene, const std::vector<RowRun>& rows)
{
    Table table({{"row", "row"},
                 {"backend", "backend"},
                 {"rays", "rays"},
                 {"agreed", "agreed"},
                 {"ties", "ties"},
                 {"largest", "largest"},
                 {"settled", "settled"},
                 {"wrong", "wrong"},
                 {"lost", "lost"},
                 {"hits", "hit hash"},
                 {"status", "status"}});
    for (const RowRun& row : rows) {
        const Traced* result = traced(row);
        if (row.key.scene != scene.label() || result == nullptr) continue;
        const Verdicts& verdicts = result->verdicts;
        table.add({kernel_title(row.key), row.key.backend, verdicts.rays, verdicts.agreed, verdicts.ties,
                   verdicts.ties > 0 ? Cell(fmt::format("{:.1e}", verdicts.largest_tie_distance)) : Cell(),
                   verdicts.settled, verdicts.wrong, verdicts.lost, hash_text(result->hit_hash),
                   std::string(name_of(status_of(row)))});
    }
    return scene_headline(scene, rows) + "\n" + (table.rows().empty() ? "" : table.text(2) + "\n");
}

std::string face_text(std::uint32_t face)
{
    if (face == NO_HIT) return "no hit";
    if (face == LOST) return "lost";
    return fmt::format("triangle {}", face);
}

std::string hit_text(const Hit& hit)
{
    const std::string tet = hit.tet == NO_TET ? "no tet" : fmt::format("tet {}", hit.tet);
    return fmt::format("{}, t {:.9g}, u {:.9g}, v {:.9g}, {}, {} steps", face_text(hit.face_id), hit.t, hit.u, hit.v,
                       tet, hit.steps);
}

std::size_t view_index(const SceneWork& scene, std::uint32_t number)
{
    const auto& numbers = scene.view_numbers();
    return static_cast<std::size_t>(std::find(numbers.begin(), numbers.end(), number) - numbers.begin());
}

std::vector<std::uint32_t> path_of(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y)
{
    if (row.packed == nullptr) return {};
    const TraceJob job = row.scene->job(view_index(*row.scene, view), &row.packed->scene);
    return walk_path(row.packed->scene, row.key.kernel, job, x, y);
}

std::string path_text(const std::vector<std::uint32_t>& path)
{
    if (path.empty()) return {};
    constexpr std::size_t shown = 200;
    std::string text = "  path of tets:";
    for (std::size_t i = 0; i < std::min(path.size(), shown); ++i)
        text += fmt::format(" {}", path[i]);
    if (path.size() > shown) text += fmt::format(" ... ({} in all)", path.size());
    return wrapped(text, 110, 2);
}

std::string wrong_ray_text(const RowRun& row)
{
    const Traced& result = *traced(row);
    std::string text;
    if (result.first_different) {
        const DifferingRay& ray = *result.first_different;
        text += fmt::format("{}: first ray that differs: view {}, pixel ({}, {})\n  this row: {}\n  openmp:   {}\n{}\n",
                            row_name(row.key), ray.view, ray.x, ray.y, hit_text(ray.ours), hit_text(ray.openmp),
                            path_text(path_of(row, ray.view, ray.x, ray.y)));
    }
    if (result.verdicts.first_wrong) {
        const WrongRay& ray = *result.verdicts.first_wrong;
        text += fmt::format("{}: first wrong ray: view {}, pixel ({}, {}): {}\n  this row:      {}\n  Embree robust: "
                            "{}, t {:.9g}\n{}\n",
                            row_name(row.key), ray.view, ray.x, ray.y, ray.reason, hit_text(ray.ours),
                            face_text(ray.reference_face), ray.reference_t,
                            path_text(path_of(row, ray.view, ray.x, ray.y)));
    }
    return text;
}

nlohmann::json check_row_json(const RowRun& row)
{
    nlohmann::json object = row_json(row, 0);
    const Traced* result = traced(row);
    if (result == nullptr) return object;
    auto& verification = object["verification"];
    if (const auto& ray = result->verdicts.first_wrong)
        verification["first_wrong"]["path"] = path_of(row, ray->view, ray->x, ray->y);
    if (const auto& ray = result->first_different)
        verification["first_different"]["path"] = path_of(row, ray->view, ray->x, ray->y);
    return object;
}

nlohmann::json check_json(const SceneRows& run, const Options& options)
{
    nlohmann::json section = result_head(options);
    section["scenes"] = nlohmann::json::array();
    for (const auto& scene : run.scenes)
        section["scenes"].push_back(scene_json(*scene, options));
    section["rows"] = nlohmann::json::array();
    for (const RowRun& row : run.rows)
        section["rows"].push_back(check_row_json(row));
    return {{"tetrace", std::move(section)}};
}

Report check_report(const SceneRows& run, const Options& options)
{
    Report report{{}, check_table(run.rows), check_json(run, options)};
    for (const auto& scene : run.scenes)
        report.text += scene_text(*scene, run.rows);
    report.text += failure_lines(run.rows);
    for (const RowRun& row : run.rows)
        if (traced(row) != nullptr) report.text += wrong_ray_text(row);
    report.text += labelled("Verified", verdict_sentence(run.rows));
    if (options.out) report.text += labelled("Result", options.out->string());
    return report;
}

/// Embree's own rows are judged only where somebody asks for them: its fast mode makes no claim that can be broken.
Options with_default_structure(Options options)
{
    const auto& required = options.required;
    const bool asked = !options.structures.empty() || !options.methods.empty() || !options.layouts.empty() ||
                       !options.backends.empty() || !options.filter.empty() ||
                       std::find(required.begin(), required.end(), "embree") != required.end();
    if (!asked) options.structures = {Structure::cdt};
    return options;
}

/// A required backend without a selected row would pass unseen.
void require_selected(const std::vector<RowKey>& keys, const std::vector<std::string>& backends)
{
    for (const std::string& name : backends)
        if (std::none_of(keys.begin(), keys.end(), [&](const RowKey& key) { return key.backend == name; }))
            throw Error(ErrorKind::missing,
                        fmt::format("--require {0}: no row of {0} is selected, so none would be judged; 'tetrace check "
                                    "--list' with the same options prints those that are",
                                    name));
}

/// A required backend whose rows were all selected but not judged has not been checked.
void require_judged(const std::vector<RowRun>& rows, const std::vector<std::string>& backends)
{
    for (const RowRun& row : rows) {
        const bool required = std::find(backends.begin(), backends.end(), row.key.backend) != backends.end();
        const Status status = status_of(row);
        if (required && (status == Status::skipped || status == Status::unsupported))
            throw Error(ErrorKind::missing, fmt::format("--require {}: {} is {}: {}", row.key.backend,
                                                        row_name(row.key), name_of(status), reason_of(row)));
    }
}

} // namespace

int check_command(const Options& asked)
{
    const Options options = with_default_structure(asked);
    const auto keys = selected_rows(options, [](const std::string&) { return true; });
    if (options.list) {
        for (const RowKey& key : keys)
            print(row_name(key) + "\n");
        return 0;
    }
    check_output(options);
    require_devices(options.required);
    require_selected(keys, options.required);
    for (const std::string& sentence : missing_default_scenes(options))
        say(sentence);
    const SceneRows run = open_and_verify(keys, options);
    deliver(options, check_report(run, options));
    require_judged(run.rows, options.required);
    return exit_code(run.rows, options.allow_flawed);
}

} // namespace tetrace
