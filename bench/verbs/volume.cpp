#include "bench/verbs/volume.h"

#include "bench/measuring/run_journal.h"
#include "bench/rows/row_tracing.h"
#include "bench/rows/sized_scene.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/ladder.h"
#include "core/base/stopwatch.h"
#include "scenes/cache.h"
#include "scenes/export_tets.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr const char* big_lattice = "lattice:64";
constexpr const char* written_lattice = "lattice:12";

VolumeScene scene_named(const std::string& name, const Options& options)
{
    VolumeScene scene{scene_label(name), options};
    scene.options.scenes = {name};
    return scene;
}

/// A lattice as a file of tets, in the cache.
std::filesystem::path write_lattice()
{
    const std::filesystem::path file = cache_directory() / "written-lattice.mesh";
    std::filesystem::create_directories(file.parent_path());
    export_tets(load_scene({written_lattice, {}}, {}).scene, file);
    return file;
}

/// One row of project for each layout is enough: tet80 is maria's.
std::vector<RowKey> rows_of_task(const Options& options)
{
    auto rows = select_rows(options, scene_labels(options));
    std::erase_if(rows, [](const RowKey& row) {
        return row.kernel.method == Method::project && row.kernel.layout == Layout::tet80;
    });
    return rows;
}

constexpr std::array volume_tasks{Task::segments, Task::tally, Task::absorb};

Options with_task(Options options, Task task)
{
    options.tasks = {task};
    return options;
}

/// Its rows of all tasks, by the scene's name on the page.
std::vector<RowKey> rows_of_scene(const VolumeScene& scene)
{
    std::vector<RowKey> rows;
    for (const Task task : volume_tasks)
        std::ranges::move(rows_of_task(with_task(scene.options, task)), std::back_inserter(rows));
    for (RowKey& row : rows)
        row.scene = scene.label;
    return rows;
}

/// The first row of project on openmp has the walks of the lines.
bool has_lines(const RowRun& row)
{
    return row.key.kernel.task == Task::segments && row.key.kernel.method == Method::project && on_reference(row.key) &&
           row.key.rays == RayKind::random;
}

/// Adds the lines of a view once, from the first such row.
class LinesOfScene {
public:
    void see(const SeenImage& image)
    {
        if (!has_lines(image.row) || image.view != next_view_) return;
        ++next_view_;
        if (!lines_) {
            mesh_of_packed_ = inverse_of(image.row.packed->data.packed_of_mesh);
            lines_.emplace(image.row.scene->loaded().scene, mesh_of_packed_);
        }
        const auto walk_of = walks_of(image.row, image.view);
        const std::size_t lines = image.row.scene->rays_per_view(); // without the repeats that fill the last group
        for (std::size_t ray = 0; ray < std::min(lines, image.hits.size()); ++ray)
            lines_->add(walk_of(ray));
    }
    [[nodiscard]] std::optional<LineTest> test() const { return lines_ ? std::optional(lines_->test()) : std::nullopt; }

private:
    std::size_t next_view_ = 0;
    std::vector<std::uint32_t> mesh_of_packed_;
    std::optional<UniformLines> lines_;
};

/// Tasks one after the other: the sessions of one are closed before those of the next are opened. Throws as
/// open_and_verify() does.
Volume run_scene(const VolumeScene& scene, const Clock& clock, double budget_s)
{
    Volume volume;
    LinesOfScene lines;
    for (const Task task : volume_tasks) {
        if (is_interrupted()) return volume;
        const Options options = with_task(scene.options, task);
        const auto keys = rows_of_task(options);
        if (keys.empty()) continue;
        MachineWatch watch = watch_of(host_pulse(resolved_threads(options)), nullptr, clock);
        const auto shares = static_cast<double>(volume_tasks.size());
        Budget budget(budget_s / shares, host_clock(), shares);
        const Recording shared{nullptr, nullptr, &watch, &budget};
        SceneRows run = open_and_verify(
            keys, options, [&](const SeenImage& image) { lines.see(image); }, shared);
        Measurement measured = measure_rows(run.rows, options, {}, shared);
        KeptPart part{records_of(run.rows), scene_records(run, options), std::move(measured)};
        for (RowRecord& row : part.rows)
            row.key.scene = scene.label;
        for (nlohmann::json& record : part.scenes)
            record["name"] = scene.label;
        append(volume.result, std::move(part), scene.label);
    }
    if (const auto test = lines.test()) volume.lines.push_back({scene.label, *test});
    return volume;
}

nlohmann::json cells_json(const CellTest& cells)
{
    return {cells.cells, cells.testable, cells.off, cells.worst};
}

CellTest cells_from(const nlohmann::json& four)
{
    return {four.at(0), four.at(1), four.at(2), four.at(3)};
}

/// What the journal keeps of a scene in addition to its part.
nlohmann::json extra_of_volume(const Volume& scene)
{
    nlohmann::json lines = nlohmann::json::array();
    for (const auto& [name, test] : scene.lines)
        lines.push_back({{"lines", test.lines},
                         {"meetings", test.meetings},
                         {"mean_length", test.mean_length},
                         {"expected_length", test.expected_length},
                         {"mean_off", test.mean_off},
                         {"tets", cells_json(test.tets)},
                         {"groups", cells_json(test.groups)}});
    return lines;
}

std::optional<Volume> kept_volume(const KeptParts& kept, const VolumeScene& asked)
{
    Volume scene;
    const std::string& label = asked.label;
    auto part = kept.find(label, rows_of_scene(asked), [&](const nlohmann::json& extra) {
        for (const nlohmann::json& test : extra)
            scene.lines.push_back(
                {label,
                 {test.at("lines"), test.at("meetings"), test.at("mean_length"), test.at("expected_length"),
                  test.at("mean_off"), cells_from(test.at("tets")), cells_from(test.at("groups"))}});
    });
    if (!part) return std::nullopt;
    scene.result.rows = std::move(part->rows);
    scene.result.scenes = std::move(part->scenes);
    scene.result.measurement = std::move(part->measurement).value();
    return scene;
}

} // namespace

std::vector<VolumeScene> volume_scenes(const Options& options, std::vector<std::string>& missing)
{
    std::vector<VolumeScene> scenes;
    for (const std::string& name : options.scenes)
        scenes.push_back(scene_named(name, options));
    if (!scenes.empty()) return scenes;
    if (const std::string reason = why_not_available("bunny"); reason.empty()) {
        for (const TetsKind tets : {TetsKind::cdt, TetsKind::rays}) {
            scenes.push_back(scene_named("bunny", options));
            scenes.back().options.tets = {tets};
            if (tets == TetsKind::rays) scenes.back().label += "-rays";
        }
    } else
        missing.push_back(fmt::format("bunny is left out: {}", reason));
    for (const std::string& name :
         {std::string(big_lattice), std::string("field"), std::string("nested"), write_lattice().string()})
        scenes.push_back(scene_named(name, options));
    return scenes;
}

Options volume_options(Options options)
{
    if (options.methods.empty())
        options.methods = {Method::plane,     Method::plucker,     Method::stp,   Method::ms06,
                           Method::plucker64, Method::barycentric, Method::maria, Method::project};
    if (options.layouts.empty()) options.layouts = {Layout::tet80, Layout::half32, Layout::tet64};
    if (options.schedules.empty()) options.schedules = {Schedule::tiles, Schedule::packets};
    const unsigned threads = resolved_threads(options);
    if (options.thread_counts.empty() && threads > 1) options.thread_counts = {1, threads};
    options.exact_samples = true;
    return options;
}

nlohmann::json volume_head(const Options& options, const std::vector<VolumeScene>& scenes)
{
    std::vector<RowKey> rows;
    nlohmann::json requests = nlohmann::json::array();
    for (const VolumeScene& scene : scenes) {
        requests.push_back(scene_head(scene_requests(scene.options).front(), scene.label));
        std::ranges::move(rows_of_scene(scene), std::back_inserter(rows));
    }
    nlohmann::json head = run_head(options, rows);
    head["scenes"] = std::move(requests);
    return head;
}

Volume run_volume(const Options& options, const std::vector<VolumeScene>& scenes, KeptParts& kept)
{
    Volume volume;
    const Clock clock = host_clock();
    for (std::size_t i = 0; i < scenes.size() && !is_interrupted(); ++i) {
        const auto add = [&](Volume scene) {
            BenchResult& result = scene.result;
            if (result.rows.empty()) return; // --filter
            std::ranges::move(scene.lines, std::back_inserter(volume.lines));
            append(volume.result, {std::move(result.rows), std::move(result.scenes), std::move(result.measurement)},
                   "");
        };
        if (auto known = kept_volume(kept, scenes[i])) {
            add(*std::move(known));
            continue;
        }
        const double left_s = options.budget_s - clock();
        if (i > 0 && left_s <= 0) {
            volume.result.missing_scenes.push_back(
                fmt::format("{} is left out: --budget leaves no time for it", scenes[i].label));
            say(volume.result.missing_scenes.back());
            continue;
        }
        Volume scene = run_scene(scenes[i], kept.clock(), left_s / static_cast<double>(scenes.size() - i));
        if (!is_interrupted() && !scene.result.rows.empty())
            kept.keep(scenes[i].label, {scene.result.rows, scene.result.scenes, scene.result.measurement},
                      extra_of_volume(scene));
        add(std::move(scene));
    }
    return volume;
}

} // namespace tetrace
