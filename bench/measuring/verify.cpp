#include "bench/measuring/verify.h"

#include "backends/openmp/kernels.h"
#include "bench/rows/answer_form.h"
#include "bench/rows/ray_store.h"
#include "bench/rows/row_tracing.h"
#include "bench/truth/crossings.h"
#include "bench/truth/oracle.h"
#include "bench/truth/tally.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"
#include "core/device/host.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>
#include <vector>

namespace tetrace {

namespace {

void poison(std::vector<Hit>& hits)
{
    std::ranges::fill(hits, Hit{POISON, POISON, 0, 0, 0, 0});
}

/// Lost rays that took as many steps as the row's device can, if that is fewer than the proof allows.
std::uint64_t count_lost_at_device_cap(const RowRun& row, std::span<const Hit> hits)
{
    const std::uint32_t cap = row.device.max_steps;
    if (cap == 0 || row.scene->counts().tets < cap) return 0;
    return static_cast<std::uint64_t>(
        std::ranges::count_if(hits, [cap](const Hit& hit) { return hit.face_id == LOST && hit.steps >= cap; }));
}

/// openmp's hits for the kernels of other backends' rows, traced only for the comparison.
class References {
public:
    References(SceneWork& scene, const Options& options) : scene_(&scene), options_(&options) {}

    const std::vector<Hit>& hits(const RowRun& compared, std::size_t view)
    {
        Reference& reference = find(*reference_of(compared.key));
        if (reference.view != view) trace(reference, view, 0);
        // A walk that is shorter than both caps is the same under either.
        const std::uint32_t cap = compared.device.max_steps;
        const bool has_longer =
            cap != 0 && std::ranges::any_of(reference.hits, [cap](const Hit& hit) { return hit.steps >= cap; });
        if (has_longer) trace(reference, view, cap);
        return reference.hits;
    }

private:
    struct Reference {
        RowRun row;
        std::optional<std::size_t> view;
        std::vector<Hit> hits;
    };

    /// cap: the most steps of the device that is compared; 0: those of openmp.
    static void trace(Reference& reference, std::size_t view, std::uint32_t cap)
    {
        RowRun& row = reference.row;
        if (row.session == nullptr)
            throw Error(ErrorKind::internal, "openmp, which the row is compared with, failed: " + reason_of(row));
        reference.hits.resize(ray_count(row, view));
        poison(reference.hits);
        const std::uint32_t own = std::exchange(row.device.max_steps, cap);
        static_cast<void>(trace_view(row, view, reference.hits));
        row.device.max_steps = own;
        reference.view = cap == 0 ? std::optional(view) : std::nullopt;
    }

    Reference& find(const RowKey& key)
    {
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

std::optional<RowKey> reference_of(const RowKey& key)
{
    if (!is_portable(key.kernel) || key.kernel.math != MathMode::exact || key == reference_row(key))
        return std::nullopt;
    return reference_row(key);
}

std::function<CrossedTets(std::size_t)> walks_of(const RowRun& row, std::size_t view)
{
    openmp::NoteFunction* const note = openmp::find_note_function(row.key.kernel);
    if (note == nullptr) throw Error(ErrorKind::internal, "openmp notes no crossings of " + row_name(row.key));
    SceneWork& scene = *row.scene;
    const PackedScene& packed = row.packed->data;
    const std::vector<Quad>& quads = scene.given_rays().rows(scene, row.key, &packed, view);
    const std::uint32_t cap = step_cap(scene.counts().tets, row.device);
    const bool absorbs = traits_of(row.key.kernel.task).absorbs;
    return [note, absorbs, cap, &packed, &quads](std::size_t ray) {
        openmp::Crossings noted;
        note(packed, absorbs, quads[ray], quads[quads.size() / GIVEN_RAY_QUADS + ray], cap, noted);
        return CrossedTets{std::move(noted.tets), std::move(noted.places)};
    };
}

/// The same steps for each row and view.
class Verifier::Parts {
public:
    Parts(SceneWork& scene, const Options& options, Clock clock)
        : scene_(&scene), clock_(std::move(clock)), threads_(resolved_threads(options)),
          oracle_(scene.loaded().scene.mesh, threads_), references_(scene, options)
    {
    }

    ImageVerdict verify(RowRun& row, std::size_t view)
    {
        ImageVerdict image;
        reference = {};
        hits.resize(ray_count(row, view));
        image.hit_hash = hash_of(hits);
        if (hits.empty()) return image; // given rays, of which this view has none
        trace_timed(row, image, view);
        image.totals = checked_totals(row, view);
        image.entering = scene_->entering(row.key, view);
        image.lost_at_device_cap = count_lost_at_device_cap(row, hits);
        image.visits = count_visits(row, view, hits, threads_);
        image.hit_hash = hash_of(hits);
        if (reference_of(row.key)) compare(row, image, view);
        Judged& judged = judge(row, view, image.hit_hash);
        image.verdicts = judged.verdicts;
        if (traits_of(row.key.kernel.task).tallies) check_tally(row, view, judged);
        if (traits_of(row.key.kernel.task).finds_hits) name_source_triangles(image);
        return image;
    }

    std::uint64_t trace(RowRun& row, std::size_t view)
    {
        hits.resize(ray_count(row, view));
        poison(hits);
        if (!hits.empty()) static_cast<void>(trace_view(row, view, hits));
        return hash_of(hits);
    }

private:
    /// The first row that had hits with this hash, and the oracle's verdict.
    struct Judged {
        RowKey key;
        std::uint64_t hash;
        Verdicts verdicts;
        std::vector<std::uint64_t> tally; ///< of the walks of these answers; empty: not summed up yet
    };

    void trace_timed(RowRun& row, ImageVerdict& image, std::size_t view)
    {
        poison(hits);
        const TraceJob job = prepare_view(row, view);
        const auto [kernel_s, wall_s] = timed_launch(*row.session, job, clock_);
        image.kernel_s = kernel_s;
        image.wall_s = wall_s;
        const Stopwatch download;
        row.session->read_back(hits);
        image.download_s = download.seconds();
    }

    [[nodiscard]] RayTotals checked_totals(const RowRun& row, std::size_t view) const
    {
        const RayTotals totals = answers_of(row.key.kernel.task).count(hits);
        if (totals.unwritten > 0) {
            const auto first = static_cast<std::size_t>(
                std::ranges::find_if(hits, [](const Hit& hit) { return hit.face_id == POISON; }) - hits.begin());
            const std::uint32_t pixel = pixel_of_ray(row, view, first);
            throw Error(ErrorKind::wrong_result,
                        fmt::format("{} of {} rays were never written, the first at view {}, pixel ({}, {})",
                                    totals.unwritten, totals.rays, scene_->view_numbers()[view],
                                    pixel % scene_->width(), pixel / scene_->width()));
        }
        return totals;
    }

    /// The oracle's verdicts on hits. Hits with the same hash are the same bytes, except with a probability of 2^-64 a
    /// pair. A verdict in a view therefore holds for all rows that trace the same rays from the same points.
    Judged& judge(const RowRun& row, std::size_t view, std::uint64_t hash)
    {
        const RowKey& key = row.key;
        if (judged_view_ != view) judged_.clear();
        judged_view_ = view;
        for (Judged& judged : judged_)
            if (judged.hash == hash && judged.key.kernel.structure == key.kernel.structure &&
                same_rays(judged.key, key))
                return judged;
        return judged_.emplace_back(Judged{key, hash, judge_anew(row, view), {}});
    }

    Verdicts judge_anew(const RowRun& row, std::size_t view)
    {
        const RowKey& key = row.key;
        if (traits_of(key.kernel.task).crosses) return judge_walks(row, view);
        const HitFormula formula = is_portable(key.kernel) ? HitFormula::kernels : HitFormula::other;
        if (key.kernel.task == Task::rays)
            return given_oracle().judge(scene_->given_rays().set(*scene_, key.rays, key.ray_order, view), hits,
                                        key.kernel.structure == Structure::bvh ? Origins::offset : Origins::own,
                                        formula);
        return oracle_.judge(scene_->view_numbers()[view], scene_->views()[view], scene_->width(), scene_->height(),
                             hits, formula);
    }

    Verdicts judge_walks(const RowRun& row, std::size_t view)
    {
        const RaySet& set = scene_->given_rays().set(*scene_, row.key.rays, row.key.ray_order, view);
        return judge_crossings(row.key.kernel.task, scene_->loaded().scene, set, hits,
                               inverse_of(row.packed->data.packed_of_mesh), walks_of(row, view), threads_);
    }

    /// The same sums as those of the walks that the answers are judged by, and as those of the answers.
    void check_tally(const RowRun& row, std::size_t view, Judged& judged)
    {
        const std::vector<std::uint64_t> tally = row.session->tally();
        require_total(tally, hits);
        if (judged.tally.empty())
            judged.tally = tally_of_walks(hits.size(), tally.size(), walks_of(row, view), threads_);
        require_sums(tally, judged.tally);
    }

    void compare(const RowRun& row, ImageVerdict& image, std::size_t view)
    {
        reference = references_.hits(row, view);
        const Differences differences = compare_hits(hits, reference, allowance_of(row));
        image.compared = true;
        image.different = differences.count;
        image.inexact = differences.inexact;
        image.max_ulps = differences.max_ulps;
        if (!differences.first) return;
        const std::size_t ray = *differences.first;
        const std::uint32_t pixel = pixel_of_ray(row, view, ray);
        image.first_different =
            DifferingRay{scene_->view_numbers()[view],
                         pixel % scene_->width(),
                         pixel / scene_->width(),
                         hits[ray],
                         reference[ray],
                         traits_of(row.key.kernel.task).tallies ? Task::segments : row.key.kernel.task};
    }

    /// Users know the triangles of their file, not the pieces that a repair cut these into.
    void name_source_triangles(ImageVerdict& image) const
    {
        const auto rename = [&](std::uint32_t& face_id) { face_id = source_triangle(scene_->loaded().scene, face_id); };
        if (auto& ray = image.first_different) {
            rename(ray->ours.face_id);
            rename(ray->openmp.face_id);
        }
        if (auto& ray = image.verdicts.first_wrong) {
            rename(ray->ours.face_id);
            rename(ray->reference_face);
        }
    }

    /// Made only if a row needs it: it builds its own BVH.
    GivenOracle& given_oracle()
    {
        if (!given_oracle_) given_oracle_.emplace(scene_->loaded().scene.mesh, threads_);
        return *given_oracle_;
    }

    SceneWork* scene_;
    Clock clock_;
    unsigned threads_;
    Oracle oracle_;
    std::optional<GivenOracle> given_oracle_;
    References references_;
    std::size_t judged_view_ = 0;
    std::vector<Judged> judged_; ///< of judged_view_

public:
    std::vector<Hit> hits;
    std::span<const Hit> reference;
};

Verifier::Verifier(SceneWork& scene, const Options& options, Clock clock)
    : parts_(std::make_unique<Parts>(scene, options, std::move(clock)))
{
}

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

Allowance allowance_of(const RowRun& row)
{
    if (!traits_of(row.key.kernel.task).finds_hits) return {}; // integers
    const std::uint32_t ulps = row.self_test ? row.self_test->allowed_ulps() : 0;
    const bool any_hit = row.key.rays == RayKind::shadow || row.key.rays == RayKind::ao;
    // Boxes are culled by quotients. Where these differ, another of several triangles may be found first.
    return {ulps, ulps > 0 && any_hit && row.key.kernel.structure == Structure::bvh};
}

namespace {

constexpr unsigned tile_height = 8;

bool is_answer_of(const Hit& counted, const Hit& hit)
{
    return counted.face_id == hit.face_id && counted.t == hit.t && counted.u == hit.u && counted.v == hit.v;
}

/// Openmp's hits of the row's rays with visits in place of tet and steps; empty if nothing counts them.
std::vector<std::uint32_t> counted_output(const RowRun& row, std::size_t view, unsigned threads)
{
    openmp::RunFunction* const count = openmp::find_function(openmp::counting_kernels(), row.key.kernel);
    if (count == nullptr) return {};
    SceneWork& scene = *row.scene;
    const PackedScene& packed = row.packed->data;
    std::vector<std::uint32_t> output(ray_count(row, view) * HIT_WORDS, POISON);
    const auto rays = row.key.kernel.task == Task::rays
                          ? std::span<const Quad>(scene.given_rays().rows(scene, row.key, &packed, view))
                          : std::span<const Quad>();
    const TraceJob job = job_of(row, view);
    on_team(threads, 1, 1,
            [&](std::size_t, SharedTiles& tiles) { count(packed, rays, job, output, tiles, tile_height); });
    return output;
}

/// The same of a row of openmp, whose hits these are; empty for others.
std::vector<std::uint32_t> counted_output(const RowRun& row, std::size_t view, std::span<const Hit> hits,
                                          unsigned threads)
{
    if (!on_reference(row.key)) return {};
    auto output = counted_output(row, view, threads);
    if (output.empty()) return {};
    const std::span<const Hit> counted = as_hits(output);
    for (std::size_t ray = 0; ray < hits.size(); ++ray)
        if (!is_answer_of(counted[ray], hits[ray]))
            throw Error(ErrorKind::internal,
                        fmt::format("ray {} has a different answer when its visits are counted", ray));
    return output;
}

} // namespace

Visits count_visits(const RowRun& row, std::size_t view, std::span<const Hit> hits, unsigned threads)
{
    auto output = counted_output(row, view, hits, threads);
    if (output.empty()) return {};
    Visits visits;
    for (const Hit& counted : as_hits(output)) {
        visits.nodes += counted.tet;
        visits.triangles += counted.steps;
    }
    visits.rays = hits.size();
    return visits;
}

Visits count_visits_of_ray(const RowRun& row, std::size_t view, std::span<const Hit> hits, std::size_t ray,
                           unsigned threads)
{
    auto output = counted_output(row, view, hits, threads);
    if (output.empty()) return {};
    const Hit& counted = as_hits(output)[ray];
    return {1, counted.tet, counted.steps};
}

std::vector<Visits> visits_by_ray(const RowRun& row, std::size_t view, unsigned threads)
{
    auto output = counted_output(row, view, threads);
    std::vector<Visits> visits;
    if (output.empty()) return visits;
    for (const Hit& counted : as_hits(output))
        visits.push_back({1, counted.tet, counted.steps});
    return visits;
}

} // namespace tetrace
