#include "bench/measuring/view_recorder.h"

#include "bench/rows/row_tracing.h"
#include "bench/truth/tally.h"

#include <fmt/format.h>

namespace tetrace {

using nlohmann::json;

void ViewRecorder::run()
{
    const std::size_t views = scene_->views().size();
    const std::size_t done = RowRecorder::run(views, scene_->label());
    if (done > 0 && done < views) scene_->keep_first_views(done);
}

json ViewRecorder::head_of(std::size_t view) const
{
    return {{"scene", scene_->label()},
            {"scene_hash", hash_text(scene_->loaded().hash)},
            {"view", scene_->view_numbers()[view]}};
}

bool ViewRecorder::is_ours(const json& entry) const
{
    return entry.value("scene", "") == scene_->label();
}

void ViewRecorder::check_entry(std::size_t view, const json& entry) const
{
    if (entry.at("scene_hash") != hash_text(scene_->loaded().hash))
        reject_journal(
            fmt::format("the journal has views of another {}: its mesh or its tets have changed", scene_->label()));
    if (view >= scene_->views().size() || entry.at("view") != scene_->view_numbers()[view])
        reject_journal(fmt::format("the journal's views of {} are not those asked for", scene_->label()));
}

std::string ViewRecorder::name_of_part(std::size_t view) const
{
    return fmt::format("view {}", scene_->view_numbers()[view]);
}

std::size_t ViewRecorder::rays_of(const RowRun& row, std::size_t view) const
{
    return ray_count(row, view);
}

std::vector<TraceJob> ViewRecorder::prepare(RowRun& row, std::size_t view)
{
    return prepare_batch(row, {view});
}

/// The first view: if a session has given rays, those of the current view would be lost.
std::optional<TraceJob> ViewRecorder::pulse_job(RowRun& row)
{
    if (traits_of(row.key.kernel.task).takes_rays) return std::nullopt;
    return job_of(row, 0);
}

ImageRecord ViewRecorder::examine(std::size_t i, std::size_t view)
{
    RowRun& row = *rows()[i];
    ImageRecord record;
    record.verdict = verifier_->verify(row, view);
    record.chained_hash = chained_hash(i, verifier_->hits());
    if (examined_) examined_({row, view, verifier_->hits(), verifier_->reference(), record.verdict}, record);
    record.verdict.verdicts.flawed = {}; // of images to come, there may be thousands
    return record;
}

std::uint64_t ViewRecorder::hash_of_answers(RowRun& row, std::size_t view)
{
    hits_.assign(ray_count(row, view), Hit{POISON, POISON, 0, 0, 0, 0});
    row.session->read_back(hits_);
    if (traits_of(row.key.kernel.task).tallies) require_total(row.session->tally(), hits_);
    return hash_of(hits_);
}

std::uint64_t ViewRecorder::repeat(RowRun& row, std::size_t view)
{
    if (traced(row)->totals.rays == 0)
        throw Error(ErrorKind::unsupported,
                    fmt::format("no primary ray hits, so rays of kind {} cannot be made", name_of(row.key.rays)));
    const std::uint64_t hash = verifier_->trace(row, view);
    if (traits_of(row.key.kernel.task).takes_rays) row.ray_hash = hash_of_rays(row);
    return hash;
}

void verify_rows(const std::vector<RowRun*>& rows, SceneWork& scene, const Options& options,
                 const ImageSeen& image_seen, const Recording& shared)
{
    Verifier verifier(scene, options, shared.budget->clock());
    std::vector<std::vector<ImageRecord>> images;
    ViewRecorder recorder(rows, images, &verifier, scene, 0, 0, shared, [&](const SeenImage& image, ImageRecord&) {
        if (image_seen) image_seen(image);
    });
    static_cast<void>(recorder.restore());
    recorder.run();
}

} // namespace tetrace
