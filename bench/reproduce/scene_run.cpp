#include "bench/reproduce/scene_run.h"

#include "bench/progress.h"
#include "bench/row_json.h"
#include "bench/rows.h"
#include "core/hash.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

bool is_timed(const RowRun& row)
{
    const Status status = status_of(row);
    return row.session != nullptr && (status == Status::ok || status == Status::flawed);
}

/// The steps of one scene's run.
class ViewRunner {
public:
    ViewRunner(SceneRun& run, const Options& options) : run_(&run), samples_(options.samples) {}

    /// The journal's entry of the view.
    json run_view(std::size_t view)
    {
        records_.assign(run_->rows.size(), {});
        traced_.clear();
        for (std::size_t i = 0; i < run_->rows.size(); ++i)
            if (run_->rows[i].session != nullptr) {
                traced_.push_back(i);
                guarded(run_->rows[i], [&] { examine(i, view); });
            }
        if (run_->build.timing) time_rows(view);
        json rows = json::object();
        for (const std::size_t i : traced_) {
            rows[row_name(run_->rows[i].key)] = outcome_json(outcome(i));
            if (traced(run_->rows[i]) != nullptr) run_->images[i].push_back(std::move(records_[i]));
        }
        return {{"scene", run_->scene->label()},
                {"scene_hash", hash_text(run_->scene->loaded().hash)},
                {"view", run_->scene->view_numbers()[view]},
                {"rows", std::move(rows)}};
    }

    void restore(std::size_t view, const json& entry)
    {
        check_entry(view, entry);
        for (std::size_t i = 0; i < run_->rows.size(); ++i)
            if (run_->rows[i].session != nullptr)
                restore(i, outcome_from_json(entry["rows"][row_name(run_->rows[i].key)]));
    }

private:
    void examine(std::size_t i, std::size_t view)
    {
        RowRun& row = run_->rows[i];
        ImageRecord& record = records_[i];
        record.verdict = run_->verifier->verify(row, view);
        std::get<Traced>(row.outcome).add(record.verdict); // a row that turns out wrong is not timed
        const auto hits = run_->verifier->hits();
        const auto& before = run_->images[i];
        record.chained_hash = hash_of(hits, before.empty() ? 0 : before.back().chained_hash);
        const std::uint32_t cap = run_->scene->job(view, &row.packed->scene).max_steps;
        record.lost_at_cap = static_cast<std::uint64_t>(std::count_if(
            hits.begin(), hits.end(), [&](const Hit& hit) { return hit.face_id == LOST && hit.steps >= cap; }));
        if (run_->flat == nullptr) return;
        record.flawed = run_->flat->walks(row, view, record.verdict.verdicts.flawed);
        record.any = run_->flat->walks_anywhere(row, view);
    }

    /// Interleaved, so that what drifts hits all rows alike. The first launch after another row's wakes the caches.
    void time_rows(std::size_t view)
    {
        for (unsigned sample = 0; sample <= samples_; ++sample)
            for (const std::size_t i : traced_)
                if (is_timed(run_->rows[i])) guarded(run_->rows[i], [&] { time_row(i, view, sample > 0); });
        for (const std::size_t i : traced_)
            if (is_timed(run_->rows[i])) guarded(run_->rows[i], [&] { check_hits(i); });
    }

    void time_row(std::size_t i, std::size_t view, bool counts)
    {
        RowRun& row = run_->rows[i];
        const TraceJob job = run_->scene->job(view, &row.packed->scene);
        const Stopwatch watch;
        row.session->launch(job);
        const double kernel_s = row.session->wait();
        const double wall_s = watch.seconds();
        if (!counts) return;
        records_[i].samples_s.push_back(kernel_s);
        records_[i].wall_samples_s.push_back(wall_s);
    }

    /// A device that answers differently under repetition must not keep its rate.
    void check_hits(std::size_t i)
    {
        hits_.assign(run_->scene->rays_per_view(), Hit{POISON, POISON, 0, 0, 0, 0});
        run_->rows[i].session->read_back(hits_);
        if (hash_of(hits_) != records_[i].verdict.hit_hash)
            throw Error(ErrorKind::wrong_result, "the hits of a view changed while it was timed");
    }

    [[nodiscard]] ImageOutcome outcome(std::size_t i) const
    {
        const Outcome& end = run_->rows[i].outcome;
        if (const auto* skipped = std::get_if<Skipped>(&end)) return *skipped;
        if (const auto* failed = std::get_if<Failed>(&end)) return *failed;
        return records_[i];
    }

    void check_entry(std::size_t view, const json& entry) const
    {
        const auto reject = [](const std::string& why) {
            throw Error(ErrorKind::usage, "--resume: " + why + "; remove the journal to begin anew");
        };
        const SceneWork& scene = *run_->scene;
        if (entry.at("scene_hash") != hash_text(scene.loaded().hash))
            reject(
                fmt::format("the journal has views of another {}: its mesh or its tets have changed", scene.label()));
        if (view >= scene.views().size() || entry.at("view") != scene.view_numbers()[view])
            reject(fmt::format("the journal's views of {} are not those asked for", scene.label()));
        for (const RowRun& row : run_->rows)
            if (row.session != nullptr && !entry.at("rows").contains(row_name(row.key)))
                reject(fmt::format("the journal has no answers of {}, which could not run then", row_name(row.key)));
    }

    void restore(std::size_t i, ImageOutcome outcome)
    {
        RowRun& row = run_->rows[i];
        if (auto* record = std::get_if<ImageRecord>(&outcome)) {
            std::get<Traced>(row.outcome).add(record->verdict);
            run_->images[i].push_back(std::move(*record));
            return;
        }
        if (auto* skipped = std::get_if<Skipped>(&outcome)) row.outcome = *skipped;
        if (auto* failed = std::get_if<Failed>(&outcome)) row.outcome = *failed;
        row.session.reset();
    }

    SceneRun* run_;
    unsigned samples_;
    std::vector<ImageRecord> records_; ///< of the view at hand, row by row
    std::vector<std::size_t> traced_;  ///< rows that the view began with
    std::vector<Hit> hits_;
};

std::vector<const json*> entries_of(const Journal* journal, const std::string& label)
{
    std::vector<const json*> entries;
    if (journal != nullptr)
        for (const json& entry : journal->entries())
            if (entry.at("scene") == label) entries.push_back(&entry);
    return entries;
}

/// Once more, after everything else that the device was given; a view of the journal's, after a resume.
void trace_first_again(SceneRun& run)
{
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        if (run.rows[i].session != nullptr)
            guarded(run.rows[i], [&] {
                if (run.verifier->trace(run.rows[i], 0) != run.images[i].front().verdict.hit_hash)
                    throw Error(ErrorKind::wrong_result, "the hits of the first view changed when it was traced again");
            });
}

void sum_up(RowRun& row, const std::vector<ImageRecord>& images)
{
    if (traced(row) == nullptr || images.empty()) return;
    Traced sum;
    row.samples_s.assign(images.front().samples_s.size(), 0);
    row.wall_samples_s = row.samples_s;
    for (const ImageRecord& image : images) {
        sum.add(image.verdict);
        sum.hit_hash = image.chained_hash;
        // A row that turned out wrong was timed no more; it has no rate.
        for (std::size_t s = 0; s < std::min(row.samples_s.size(), image.samples_s.size()); ++s) {
            row.samples_s[s] += image.samples_s[s];
            row.wall_samples_s[s] += image.wall_samples_s[s];
        }
    }
    sum.first_view_hash = images.front().verdict.hit_hash;
    sum.last_view_hash = images.back().verdict.hit_hash;
    row.outcome = std::move(sum);
}

} // namespace

void SceneRun::close()
{
    row_records = json::array();
    for (RowRun& row : rows) {
        row_records.push_back(row_json(row));
        row.session.reset();
    }
    verifier.reset();
}

void ViewProgress::show(const std::string& stage) const
{
    const auto fraction = static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(all, 1));
    const double left_s =
        here == 0 ? -1 : watch.seconds() / static_cast<double>(here) * static_cast<double>(all - done);
    progress_line().show(stage, fraction, left_s);
}

SceneRun open_scene_run(const SceneBuild& build, const Options& options)
{
    SceneRun run;
    run.build = build;
    const auto keys = select_rows(options, {build.label});
    try {
        run.scene = std::make_unique<SceneWork>(load_work(build.request, options, build.label));
        if (build.robustness) run.flat = std::make_unique<FlatTets>(*run.scene);
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

void run_views(SceneRun& run, const Options& options, Journal* journal, ViewProgress& progress)
{
    if (run.scene == nullptr) return;
    ViewRunner runner(run, options);
    const auto entries = entries_of(journal, run.scene->label());
    for (std::size_t view = 0; view < entries.size(); ++view)
        runner.restore(view, *entries[view]);
    progress.done += entries.size();
    for (std::size_t view = entries.size(); view < run.scene->views().size(); ++view) {
        progress.show("reproducing, " + run.scene->label());
        const json entry = runner.run_view(view);
        if (journal != nullptr) journal->append(entry);
        progress.done += 1;
        progress.here += 1;
    }
    trace_first_again(run);
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        sum_up(run.rows[i], run.images[i]);
    progress_line().clear();
}

} // namespace tetrace
