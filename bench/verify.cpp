#include "bench/verify.h"

#include "bench/progress.h"
#include "bench/stopwatch.h"
#include "core/hash.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace tetrace {

namespace {

bool needs_reference(const RowKey& key)
{
    return key.kernel.structure == Structure::cdt && key.kernel.math == MathMode::exact &&
           key.backend != reference_backend;
}

void poison(std::vector<Hit>& hits)
{
    std::fill(hits.begin(), hits.end(), Hit{POISON, POISON, 0, 0, 0, 0});
}

/// openmp's hits for the kernels of other backends' rows, traced for the comparison alone.
class References {
public:
    References(SceneWork& scene, const Options& options) : scene_(&scene), options_(&options) {}

    const std::vector<Hit>& hits(const RowKey& key, std::size_t view)
    {
        Reference& reference = find(key);
        if (reference.view == view) return reference.hits;
        RowRun& row = reference.row;
        if (row.session == nullptr)
            throw Error(ErrorKind::internal, "openmp, which the row is compared with, failed: " + reason_of(row));
        reference.hits.resize(scene_->rays_per_view());
        poison(reference.hits);
        row.session->launch(scene_->job(view, &row.packed->scene));
        static_cast<void>(row.session->wait());
        row.session->read_back(reference.hits);
        reference.view = view;
        return reference.hits;
    }

private:
    struct Reference {
        RowRun row;
        std::optional<std::size_t> view;
        std::vector<Hit> hits;
    };

    Reference& find(RowKey key)
    {
        key.backend = reference_backend;
        key.device = 0;
        key.kernel.schedule = Schedule::tiles;
        for (const auto& reference : references_)
            if (reference->row.key == key) return *reference;
        references_.push_back(
            std::make_unique<Reference>(Reference{open_row(key, *scene_, *options_), std::nullopt, {}}));
        return *references_.back();
    }

    SceneWork* scene_;
    const Options* options_;
    std::vector<std::unique_ptr<Reference>> references_;
};

} // namespace

/// The same steps for each row and view.
class Verifier::Parts {
public:
    Parts(SceneWork& scene, const Options& options)
        : scene_(&scene), oracle_(scene.loaded().scene.mesh, resolved_threads(options)), references_(scene, options),
          hits(scene.rays_per_view())
    {
    }

    ImageVerdict verify(RowRun& row, std::size_t view)
    {
        ImageVerdict image;
        trace_timed(row, image, view);
        image.totals = checked_totals(view);
        image.hit_hash = hash_of(hits);
        reference = {};
        if (needs_reference(row.key)) compare(row, image, view);
        image.verdicts = judge(view, image.hit_hash);
        return image;
    }

    std::uint64_t trace(RowRun& row, std::size_t view)
    {
        poison(hits);
        static_cast<void>(trace_kernel(row, view));
        row.session->read_back(hits);
        return hash_of(hits);
    }

private:
    /// Device seconds.
    double trace_kernel(RowRun& row, std::size_t view)
    {
        row.session->launch(scene_->job(view, row.packed ? &row.packed->scene : nullptr));
        return row.session->wait();
    }

    void trace_timed(RowRun& row, ImageVerdict& image, std::size_t view)
    {
        poison(hits);
        const Stopwatch watch;
        image.kernel_s = trace_kernel(row, view);
        image.wall_s = watch.seconds();
        const Stopwatch download;
        row.session->read_back(hits);
        image.download_s = download.seconds();
    }

    [[nodiscard]] RayTotals checked_totals(std::size_t view) const
    {
        const RayTotals totals = count_rays(hits);
        if (totals.unwritten > 0) {
            const auto first = static_cast<std::size_t>(
                std::find_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.face_id == POISON; }) -
                hits.begin());
            throw Error(ErrorKind::wrong_result,
                        fmt::format("{} of {} rays were never written, the first at view {}, pixel ({}, {})",
                                    totals.unwritten, totals.rays, scene_->view_numbers()[view],
                                    first % scene_->width(), first / scene_->width()));
        }
        return totals;
    }

    /// The oracle's verdict on hits. Hits of one hash are the same bytes but with a probability of 2^-64 a pair: what
    /// was judged once in a view holds for all rows.
    Verdicts judge(std::size_t view, std::uint64_t hash)
    {
        if (judged_view_ != view) judged_.clear();
        judged_view_ = view;
        if (const auto found = judged_.find(hash); found != judged_.end()) return found->second;
        return judged_
            .emplace(hash, oracle_.judge(scene_->view_numbers()[view], scene_->views()[view], scene_->width(),
                                         scene_->height(), hits))
            .first->second;
    }

    void compare(const RowRun& row, ImageVerdict& image, std::size_t view)
    {
        reference = references_.hits(row.key, view);
        const Differences differences = compare_hits(hits, reference, allowed_ulps(row));
        image.compared = true;
        image.different = differences.count;
        image.inexact = differences.inexact;
        image.largest_ulps = differences.largest_ulps;
        if (!differences.first) return;
        const std::size_t ray = *differences.first;
        image.first_different =
            DifferingRay{scene_->view_numbers()[view], static_cast<std::uint32_t>(ray % scene_->width()),
                         static_cast<std::uint32_t>(ray / scene_->width()), hits[ray], reference[ray]};
    }

    SceneWork* scene_;
    Oracle oracle_;
    References references_;
    std::size_t judged_view_ = 0;
    std::map<std::uint64_t, Verdicts> judged_; ///< of judged_view_, by the hash of its hits

public:
    std::vector<Hit> hits;
    std::span<const Hit> reference;
};

Verifier::Verifier(SceneWork& scene, const Options& options) : parts_(std::make_unique<Parts>(scene, options)) {}

Verifier::~Verifier() = default;

ImageVerdict Verifier::verify(RowRun& row, std::size_t view)
{
    return parts_->verify(row, view);
}

std::uint64_t Verifier::trace(RowRun& row, std::size_t view)
{
    return parts_->trace(row, view);
}

std::span<const Hit> Verifier::hits() const
{
    return parts_->hits;
}

std::span<const Hit> Verifier::reference() const
{
    return parts_->reference;
}

namespace {

void verify_view(Verifier& verifier, RowRun& row, std::size_t view)
{
    const ImageVerdict image = verifier.verify(row, view);
    Traced& result = std::get<Traced>(row.outcome);
    result.add(image);
    result.last_view_hash = image.hit_hash;
    if (view == 0) result.first_view_hash = image.hit_hash;
    result.hit_hash = hash_of(verifier.hits(), result.hit_hash);
}

/// A device that answers differently under repetition is caught here, after everything else that it was given.
void verify_again(Verifier& verifier, RowRun& row)
{
    if (verifier.trace(row, 0) != traced(row)->first_view_hash)
        throw Error(ErrorKind::wrong_result, fmt::format("the hits of view {} changed when it was traced again",
                                                         row.scene->view_numbers().front()));
}

} // namespace

std::uint32_t allowed_ulps(const RowRun& row)
{
    return row.self_test ? row.self_test->allowed_ulps() : 0;
}

void verify_rows(const std::vector<RowRun*>& rows, SceneWork& scene, const Options& options,
                 const ImageSeen& image_seen)
{
    // Views outside, rows inside: the oracle traces each view once for all rows.
    Verifier verifier(scene, options);
    const double images = static_cast<double>(scene.views().size() * rows.size());
    double done = 0;
    for (std::size_t view = 0; view < scene.views().size(); ++view)
        for (RowRun* row : rows) {
            progress_line().show("verifying " + scene.label(), done / images);
            done += 1;
            if (row->session == nullptr) continue;
            guarded(*row, [&] {
                verify_view(verifier, *row, view);
                if (image_seen) image_seen({*row, view, verifier.hits(), verifier.reference()});
            });
        }
    for (RowRun* row : rows)
        if (row->session != nullptr) guarded(*row, [&] { verify_again(verifier, *row); });
    progress_line().clear();
}

} // namespace tetrace
