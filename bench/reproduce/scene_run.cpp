#include "bench/reproduce/scene_run.h"

#include "bench/measuring/view_recorder.h"
#include "bench/reproduce/paper.h"
#include "bench/rows/rows.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

/// The options, with only those selections that apply to the structure's rows.
Options options_of(Structure structure, Options options)
{
    options.structures = {structure};
    std::erase_if(options.layouts, [&](Layout layout) { return structure_of(layout) != structure; });
    std::erase_if(options.methods, [&](Method method) { return !is_method_of(structure, method); });
    return options;
}

/// The rows of the CDT's fastest walks, those through records, unless the options left them out.
std::vector<RowKey> rows_of_fastest_walks(const Options& options, const std::string& label)
{
    Options of_walks = options_of(Structure::cdt, options);
    const auto narrow = [](auto& list, auto values) {
        if (!list.empty())
            std::erase_if(values, [&](auto value) { return std::ranges::find(list, value) == list.end(); });
        list = values;
        return !values.empty();
    };
    const bool takes_method = narrow(of_walks.methods, std::vector{Method::project});
    const bool takes_layout = narrow(of_walks.layouts, std::vector{Layout::half32, Layout::tet64});
    return takes_method && takes_layout ? unfiltered_rows(of_walks, {label}) : std::vector<RowKey>();
}

std::vector<RowKey> unfiltered_rows_of(const SceneBuild& build, const Options& options)
{
    if (build.methods && !build.rivals) return unfiltered_rows(options, {build.label});
    Options of_cdt = options_of(Structure::cdt, options);
    if (!build.methods) of_cdt.methods = {Method::maria};
    auto rows = unfiltered_rows(of_cdt, {build.label});
    const auto add = [&](std::vector<RowKey> others) { std::ranges::move(others, std::back_inserter(rows)); };
    if (!build.methods && build.build == rays_build) add(rows_of_fastest_walks(options, build.label));
    if (build.rivals) add(unfiltered_rows(options_of(Structure::bvh, options), {build.label}));
    return rows;
}

} // namespace

std::vector<RowKey> rows_of_build(const SceneBuild& build, const Options& options)
{
    return filtered_rows(options, unfiltered_rows_of(build, options));
}

bool is_for_rays(const SceneRun& run)
{
    if (run.build.build == rays_build) return true;
    return run.scene != nullptr && run.scene->loaded().scene.build.optimised.tets == TetsKind::rays;
}

std::string tets_name(const SceneRun& run)
{
    return is_for_rays(run) ? "tets for rays" : "CDT";
}

SceneRuns runs_of_cdt(const SceneRuns& runs)
{
    SceneRuns found;
    std::ranges::copy_if(runs, std::back_inserter(found), [](const SceneRun* run) { return !is_for_rays(*run); });
    return found;
}

void SceneRun::close()
{
    for (RowRun& row : rows)
        row.session.reset();
    verifier.reset();
}

Sampling sampling_of(const SceneWork& scene, std::size_t population)
{
    const auto& views = scene.view_numbers();
    if (!is_even(views, population)) return Sampling::chosen;
    const bool is_whole = views.size() == population && scene.rays_per_view() >= paper::image_pixels;
    return is_whole ? Sampling::whole : Sampling::even;
}

namespace {

void load_scene_of(SceneRun& run, const Options& options)
{
    run.scene = std::make_unique<SceneWork>(load_work(run.build.request, options, run.build.label));
    run.likeness = likeness_of(run.build.scene, run.scene->loaded().scene, run.scene->counts());
    const bool is_of_papers = !options.own_cameras && options.camera_set == CameraSet::flight;
    run.sampling = is_of_papers ? sampling_of(*run.scene, camera_set_size(options)) : Sampling::chosen;
    if (run.build.robustness) run.flat = std::make_unique<FlatTets>(*run.scene);
}

} // namespace

SceneRun recorded_scene_run(const SceneBuild& build, const Options& options, const std::vector<RowRecord>& rows)
{
    SceneRun run;
    run.build = build;
    load_scene_of(run, options);
    for (const RowRecord& row : rows)
        run.rows.emplace_back(closed_row(row)).scene = run.scene.get();
    run.images.resize(run.rows.size());
    return run;
}

SceneRun open_scene_run(const SceneBuild& build, const Options& options)
{
    SceneRun run;
    run.build = build;
    const auto keys = rows_of_build(build, options);
    try {
        load_scene_of(run, options);
        run.verifier = std::make_unique<Verifier>(*run.scene, options);
        for (const RowKey& key : keys)
            run.rows.push_back(open_row(key, *run.scene, options));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::usage || error.kind() == ErrorKind::interrupted) throw;
        for (const RowKey& key : keys)
            run.rows.push_back(failed_row(key, error));
    }
    run.images.resize(run.rows.size());
    return run;
}

namespace {

/// Looks for what only the paper's tables ask for.
void examine_walks(SceneRun& run, const SeenImage& image, ImageRecord& record)
{
    const std::uint32_t cap = job_of(image.row, image.view).max_steps;
    record.lost_at_cap = static_cast<std::uint64_t>(
        std::ranges::count_if(image.hits, [&](const Hit& hit) { return hit.face_id == LOST && hit.steps >= cap; }));
    if (run.flat == nullptr || !is_cdt(image.row)) return;
    record.flawed = run.flat->walks(image.row, image.view, record.verdict.verdicts.flawed);
    record.any = run.flat->walks_anywhere(image.row, image.view);
}

} // namespace

void run_views(SceneRun& run, const Options& options, const Recording& shared)
{
    if (run.scene == nullptr) return;
    const unsigned samples = run.build.timing ? options.samples : 0;
    ViewRecorder recorder(pointers_to(run.rows), run.images, run.verifier.get(), *run.scene, samples, options.sample_s,
                          shared,
                          [&](const SeenImage& image, ImageRecord& record) { examine_walks(run, image, record); });
    const std::size_t views = run.scene->views().size(), restored = recorder.restore();
    if (restored < views) shared.budget->plan_views(run.rows, samples, options.sample_s, restored);
    recorder.run();
    if (run.scene->views().size() < views) run.sampling = Sampling::chosen; // interrupted
}

} // namespace tetrace
