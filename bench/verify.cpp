#include "bench/verify.h"

#include "bench/progress.h"
#include "bench/stopwatch.h"
#include "core/hash.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr const char* reference_backend = "openmp";

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

/// One scene's verification: the same steps for each row and view.
class Verification {
public:
    Verification(SceneWork& scene, const Options& options)
        : scene_(&scene), oracle_(scene.loaded().scene.mesh, resolved_threads(options)), references_(scene, options),
          hits_(scene.rays_per_view())
    {
    }

    void verify(RowRun& row, std::size_t view)
    {
        trace(row, view);
        Traced& result = std::get<Traced>(row.outcome);
        count(row, result);
        result.last_view_hash = hash_of(hits_);
        result.hit_hash = hash_of(hits_, result.hit_hash);
        if (needs_reference(row.key)) compare(row, result, view);
        result.verdicts.add(oracle_.judge(scene_->view_numbers()[view], scene_->views()[view], scene_->width(),
                                          scene_->height(), hits_));
    }

    [[nodiscard]] std::span<const Hit> hits() const { return hits_; }

private:
    void trace(RowRun& row, std::size_t view)
    {
        poison(hits_);
        Traced& result = std::get<Traced>(row.outcome);
        const Stopwatch watch;
        row.session->launch(scene_->job(view, row.packed ? &row.packed->scene : nullptr));
        result.kernel_s += row.session->wait();
        result.wall_s += watch.seconds();
        const Stopwatch download;
        row.session->read_back(hits_);
        result.download_s += download.seconds();
    }

    void count(const RowRun& row, Traced& result) const
    {
        const RayTotals totals = count_rays(hits_);
        if (totals.unwritten > 0)
            throw Error(ErrorKind::internal, fmt::format("{}: {} of {} rays were never written", row_name(row.key),
                                                         totals.unwritten, totals.rays));
        result.totals.add(totals);
    }

    void compare(const RowRun& row, Traced& result, std::size_t view)
    {
        const auto& reference = references_.hits(row.key, view);
        const Differences differences = compare_hits(hits_, reference);
        result.compared = true;
        result.different += differences.count;
        if (!differences.first || result.first_different) return;
        const std::size_t ray = *differences.first;
        result.first_different =
            DifferingRay{scene_->view_numbers()[view], static_cast<std::uint32_t>(ray % scene_->width()),
                         static_cast<std::uint32_t>(ray / scene_->width()), hits_[ray], reference[ray]};
    }

    SceneWork* scene_;
    Oracle oracle_;
    References references_;
    std::vector<Hit> hits_;
};

} // namespace

void verify_rows(const std::vector<RowRun*>& rows, SceneWork& scene, const Options& options,
                 const ImageSeen& image_seen)
{
    // Views outside, rows inside: the oracle traces each view once for all rows.
    Verification verification(scene, options);
    const double images = static_cast<double>(scene.views().size() * rows.size());
    double done = 0;
    for (std::size_t view = 0; view < scene.views().size(); ++view)
        for (RowRun* row : rows) {
            progress_line().show("verifying " + scene.label(), done / images);
            done += 1;
            if (row->session == nullptr) continue;
            guarded(*row, [&] {
                verification.verify(*row, view);
                if (image_seen) image_seen(*row, view, verification.hits());
            });
        }
    progress_line().clear();
}

} // namespace tetrace
