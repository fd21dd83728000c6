#include "bench/verbs/volume.h"

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

/// A scene of the page: its name in rows, and the options that ask for it alone.
struct VolumeScene {
    std::string label;
    Options options;
};

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

/// What is not named: the methods that walk through all tets, each on the layouts that are made for it, on openmp with
/// one thread and with all, also in packets.
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

/// One row of project for each layout is enough: tet80 is maria's.
std::vector<RowKey> rows_of_task(const Options& options)
{
    auto rows = select_rows(options, scene_labels(options));
    std::erase_if(rows, [](const RowKey& row) {
        return row.kernel.method == Method::project && row.kernel.layout == Layout::tet80;
    });
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

/// Task by task: the sessions of one are closed before those of the next are opened. Throws as open_and_verify() does.
void run_scene(Volume& volume, const VolumeScene& scene, const Clock& clock, double budget_s)
{
    LinesOfScene lines;
    constexpr std::array tasks{Task::segments, Task::tally, Task::absorb};
    for (const Task task : tasks) {
        if (is_interrupted()) return;
        Options options = scene.options;
        options.tasks = {task};
        const auto keys = rows_of_task(options);
        if (keys.empty()) continue;
        MachineWatch watch = watch_of(host_pulse(resolved_threads(options)), nullptr, clock);
        const auto shares = static_cast<double>(tasks.size());
        Budget budget(budget_s / shares, host_clock(), shares);
        const Recording shared{nullptr, nullptr, &watch, &budget};
        SceneRows run = open_and_verify(
            keys, options, [&](const SeenImage& image) { lines.see(image); }, shared);
        Measurement measured = measure_rows(run.rows, options, {}, shared);
        auto rows = records_of(run.rows);
        auto records = scene_records(run, options);
        for (RowRecord& row : rows)
            row.key.scene = scene.label;
        for (nlohmann::json& record : records)
            record["name"] = scene.label;
        append(volume.result, std::move(rows), records, std::move(measured), scene.label);
    }
    if (const auto test = lines.test()) volume.lines.push_back({scene.label, *test});
}

} // namespace

Volume run_volume(const Options& asked)
{
    Volume volume;
    const Options options = volume_options(asked);
    const auto scenes = volume_scenes(options, volume.result.missing_scenes);
    for (const std::string& sentence : volume.result.missing_scenes)
        say(sentence);
    const Clock clock = host_clock();
    for (std::size_t i = 0; i < scenes.size() && !is_interrupted(); ++i) {
        const double left_s = options.budget_s - clock();
        if (i > 0 && left_s <= 0) {
            volume.result.missing_scenes.push_back(
                fmt::format("{} is left out: --budget leaves no time for it", scenes[i].label));
            say(volume.result.missing_scenes.back());
            continue;
        }
        run_scene(volume, scenes[i], clock, left_s / static_cast<double>(scenes.size() - i));
    }
    complete(volume.result, options);
    return volume;
}

} // namespace tetrace
