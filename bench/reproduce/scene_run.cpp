#include "bench/reproduce/scene_run.h"

#include "bench/reproduce/paper.h"
#include "bench/rows/rows.h"
#include "core/base/hash.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

using nlohmann::json;

/// The views of one scene.
class ViewRecorder : public RowRecorder {
public:
    ViewRecorder(SceneRun& run, unsigned samples, double sample_s) : RowRecorder(run, samples, sample_s), run_(&run) {}

private:
    [[nodiscard]] json head_of(std::size_t view) const override
    {
        json head = {{"scene", run_->scene->label()},
                     {"scene_hash", hash_text(run_->scene->loaded().hash)},
                     {"view", run_->scene->view_numbers()[view]}};
        if (view == 0) head["open_s"] = run_->open_s;
        return head;
    }

    [[nodiscard]] bool is_ours(const json& entry) const override
    {
        return entry.value("scene", "") == run_->scene->label();
    }

    void check_entry(std::size_t view, const json& entry) const override
    {
        const SceneWork& scene = *run_->scene;
        if (entry.at("scene_hash") != hash_text(scene.loaded().hash))
            reject_journal(
                fmt::format("the journal has views of another {}: its mesh or its tets have changed", scene.label()));
        if (view >= scene.views().size() || entry.at("view") != scene.view_numbers()[view])
            reject_journal(fmt::format("the journal's views of {} are not those asked for", scene.label()));
    }

    void prepare(RowRun&, std::size_t) override {} // the scene is all that its rays need

    [[nodiscard]] TraceJob job_of(const RowRun& row, std::size_t view) const override
    {
        return run_->scene->job(view, row.packed != nullptr ? &row.packed->data : nullptr, row.device);
    }

    [[nodiscard]] bool can_repeat_first_job() const override { return true; } // primary rays need no others

    [[nodiscard]] ImageRecord examine(std::size_t i, std::size_t view) override
    {
        RowRun& row = run_->rows[i];
        ImageRecord record;
        record.verdict = run_->verifier->verify(row, view);
        const auto hits = run_->verifier->hits();
        const auto& before = run_->images[i];
        record.chained_hash = hash_of(hits, before.empty() ? 0 : before.back().chained_hash);
        const std::uint32_t cap = job_of(row, view).max_steps;
        record.lost_at_cap = static_cast<std::uint64_t>(
            std::ranges::count_if(hits, [&](const Hit& hit) { return hit.face_id == LOST && hit.steps >= cap; }));
        if (run_->flat == nullptr || !is_cdt(row)) return record;
        record.flawed = run_->flat->walks(row, view, record.verdict.verdicts.flawed);
        record.any = run_->flat->walks_anywhere(row, view);
        return record;
    }

    void keep_first_parts(std::size_t parts) override
    {
        run_->scene->keep_first_views(parts);
        run_->sampling = Sampling::chosen;
    }

    [[nodiscard]] std::uint64_t hash_of_answers(RowRun& row, std::size_t) override
    {
        hits_.assign(run_->scene->rays_per_view(), Hit{POISON, POISON, 0, 0, 0, 0});
        row.session->read_back(hits_);
        return hash_of(hits_);
    }

    SceneRun* run_;
    std::vector<Hit> hits_;
};

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
    return takes_method && takes_layout ? select_rows(of_walks, {label}) : std::vector<RowKey>();
}

} // namespace

std::vector<RowKey> rows_of_build(const SceneBuild& build, const Options& options)
{
    if (build.methods && !build.rivals) return select_rows(options, {build.label});
    Options of_cdt = options_of(Structure::cdt, options);
    if (!build.methods) of_cdt.methods = {Method::maria};
    auto rows = select_rows(of_cdt, {build.label});
    const auto add = [&](std::vector<RowKey> others) { std::ranges::move(others, std::back_inserter(rows)); };
    if (!build.methods && build.build == rays_build) add(rows_of_fastest_walks(options, build.label));
    if (build.rivals) add(select_rows(options_of(Structure::bvh, options), {build.label}));
    return rows;
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
    run.sampling = sampling_of(*run.scene, view_count(options.camera_set));
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
    const Stopwatch watch;
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
    run.open_s = watch.seconds();
    return run;
}

void run_views(SceneRun& run, const Options& options, Journal* journal, RunProgress& progress, MachineWatch* watch,
               Budget& budget)
{
    if (run.scene == nullptr) return;
    ViewRecorder recorder(run, run.build.timing ? options.samples : 0, options.sample_s);
    recorder.run(run.scene->views().size(), run.scene->label(), journal, progress, watch, budget);
}

} // namespace tetrace
