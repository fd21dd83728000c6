#include "bench/reproduce/search_run.h"

#include "bench/rows/row_tracing.h"
#include "bench/rows/rows.h"
#include "core/base/hash.h"
#include "core/rays/search_set.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;
using Faces = std::vector<std::uint32_t>;

constexpr std::uint32_t batch_rays = 1'638'400;
constexpr std::uint32_t min_batches = 20;

/// openmp's faces of a batch, for comparison with other backends' faces: from openmp's own row, else found only for the
/// comparison.
class FaceReferences {
public:
    FaceReferences(const SearchRun& run, const Options& options) : run_(&run), options_(&options) {}

    void forget() { faces_.clear(); } ///< another batch begins

    void set(const KernelId& kernel, const Faces& faces) { faces_.insert_or_assign(name_of(kernel), faces); }

    const Faces& of(const KernelId& kernel, const SearchRays& rays)
    {
        const std::string name = name_of(kernel);
        if (const auto known = faces_.find(name); known != faces_.end()) return known->second;
        auto& session = sessions_[name];
        if (session == nullptr)
            session = reference_backend().open(0, kernel, {nullptr, &run_->tets.at(kernel.layout).data},
                                               session_options(*options_));
        session->set_rays(rays.quads);
        Faces faces(rays.count(), POISON);
        static_cast<void>(session->search(search_job(rays.count()), faces));
        return faces_[name] = std::move(faces);
    }

private:
    const SearchRun* run_;
    const Options* options_;
    std::map<std::string, std::unique_ptr<Session>> sessions_; ///< by the kernel's name
    std::map<std::string, Faces> faces_;                       ///< of the current batch
};

Hit as_hit(std::uint32_t face, std::uint32_t tet)
{
    return {face, tet, 0, 0, 0, 0};
}

Verdicts judge_all(const SearchRays& rays, const Faces& faces, std::uint32_t rays_per_tet)
{
    Verdicts verdicts;
    verdicts.rays = faces.size();
    for (std::size_t ray = 0; ray < faces.size(); ++ray) {
        switch (judge(rays, ray, faces[ray])) {
        case SearchVerdict::right: ++verdicts.agreed; break;
        case SearchVerdict::tie: ++verdicts.ties; break;
        case SearchVerdict::wrong: ++verdicts.wrong; break;
        case SearchVerdict::lost: ++verdicts.lost; break;
        }
        if (verdicts.clean() || verdicts.first_wrong) continue;
        const std::uint32_t tet = half_face_tet(rays.half_face(ray));
        const auto exact_face = static_cast<std::uint32_t>(std::countr_zero(rays.exits[ray]));
        const auto number = static_cast<std::uint32_t>(ray % rays_per_tet);
        verdicts.first_wrong = WrongRay{tet, number, 0, as_hit(faces[ray], tet), exact_face, 0, {}};
    }
    return verdicts;
}

/// The batches of a run.
class BatchRecorder : public RowRecorder {
public:
    BatchRecorder(SearchRun& run, const Options& options, const Recording& shared)
        : RowRecorder(pointers_to(run.rows), run.images, options.samples, options.sample_s, shared), run_(&run),
          references_(run, options)
    {
    }

    [[nodiscard]] SearchRays rays_of_batch(std::size_t batch) const
    {
        return search_rays(static_cast<std::uint32_t>(batch) * run_->batch_tets, tets_of(batch), run_->size.rays);
    }

private:
    [[nodiscard]] json head_of(std::size_t part) const override { return {{"batch", run_->shard.part(part)}}; }

    [[nodiscard]] bool is_ours(const json& entry) const override { return entry.contains("batch"); }

    void check_entry(std::size_t part, const json& entry) const override
    {
        const std::size_t batch = run_->shard.part(part);
        if (batch >= batch_count(run_->size) || entry["batch"] != batch)
            reject_journal("the journal's batches of searches are not those asked for");
    }

    [[nodiscard]] std::string name_of_part(std::size_t part) const override
    {
        return fmt::format("batch {}", run_->shard.part(part));
    }

    [[nodiscard]] std::size_t rays_of(const RowRun&, std::size_t part) const override
    {
        return std::size_t{tets_of(run_->shard.part(part))} * run_->size.rays;
    }

    [[nodiscard]] std::vector<TraceJob> prepare(RowRun& row, std::size_t part) override
    {
        const std::size_t batch = run_->shard.part(part);
        load(batch);
        const auto [given, is_new] = given_.try_emplace(&row, batch);
        if (is_new || given->second != batch) row.session->set_rays(rays_.quads);
        given->second = batch;
        return {search_job(rays_of(row, part))};
    }

    /// With other rays of as many as the first batch has.
    [[nodiscard]] std::optional<TraceJob> pulse_job(RowRun& row) override
    {
        if (!loaded_ || tets_of(*loaded_) != tets_of(run_->shard.part(0))) return std::nullopt;
        return search_job(rays_of(row, 0));
    }

    [[nodiscard]] ImageRecord examine(std::size_t i, std::size_t part) override
    {
        RowRun& row = *rows()[i];
        ImageRecord record;
        ImageVerdict& verdict = record.verdict;
        const auto [kernel_s, wall_s] = timed_launch(*row.session, prepare(row, part));
        verdict.kernel_s = kernel_s;
        verdict.wall_s = wall_s;
        verdict.hit_hash = hash_of_answers(row, part);
        verdict.download_s = row.session->download_s();
        record.chained_hash = chained_hash(i, faces_);
        compare(row, verdict);
        verdict.verdicts = judged(verdict.hit_hash);
        verdict.totals.rays = faces_.size();
        verdict.totals.lost = verdict.verdicts.lost;
        verdict.totals.hits = verdict.totals.rays - verdict.totals.lost;
        return record;
    }

    [[nodiscard]] std::uint64_t hash_of_answers(RowRun& row, std::size_t) override
    {
        faces_.assign(rays_.count(), POISON);
        row.session->read_back(faces_);
        return hash_of(faces_);
    }

    [[nodiscard]] std::uint64_t repeat(RowRun& row, std::size_t part) override
    {
        static_cast<void>(timed_launch(*row.session, prepare(row, part)));
        return hash_of_answers(row, part);
    }

    /// Exact mode guarantees the same faces on every device, and with any number of threads.
    void compare(const RowRun& row, ImageVerdict& verdict)
    {
        if (is_reference(row.key)) {
            references_.set(row.key.kernel, faces_);
            return;
        }
        verdict.compared = true;
        const Faces& reference = references_.of(row.key.kernel, rays_);
        for (std::size_t ray = 0; ray < faces_.size(); ++ray) {
            if (faces_[ray] == reference[ray]) continue;
            const std::uint32_t tet = half_face_tet(rays_.half_face(ray));
            const auto number = static_cast<std::uint32_t>(ray % run_->size.rays);
            if (verdict.different++ == 0)
                verdict.first_different =
                    DifferingRay{tet, number, 0, as_hit(faces_[ray], tet), as_hit(reference[ray], tet)};
        }
        verdict.inexact = verdict.different;
    }

    /// Faces with the same hash are the same, except with a probability of 2^-64 a pair: one verdict holds for all
    /// rows.
    const Verdicts& judged(std::uint64_t hash)
    {
        const auto found = judged_.find(hash);
        return found != judged_.end() ? found->second
                                      : judged_.emplace(hash, judge_all(rays_, faces_, run_->size.rays)).first->second;
    }

    [[nodiscard]] std::uint32_t tets_of(std::size_t batch) const
    {
        return std::min(run_->batch_tets, run_->size.tets - static_cast<std::uint32_t>(batch) * run_->batch_tets);
    }

    void load(std::size_t batch)
    {
        if (loaded_ == batch) return;
        rays_ = rays_of_batch(batch);
        references_.forget();
        judged_.clear();
        loaded_ = batch;
    }

    SearchRun* run_;
    FaceReferences references_;
    std::map<const RowRun*, std::size_t> given_; ///< the batch whose rays each row's session has
    std::optional<std::size_t> loaded_;
    SearchRays rays_; ///< of the loaded batch
    Faces faces_;     ///< that were last read back
    std::map<std::uint64_t, Verdicts> judged_;
};

} // namespace

bool is_reference(const RowKey& key)
{
    return on_reference(key) && key.threads == 1;
}

std::uint32_t tets_of_batch(const SearchSize& size)
{
    const std::uint32_t fitting = std::max(batch_rays / size.rays, 1u);
    return std::clamp(size.tets / min_batches, 1u, fitting);
}

std::uint32_t batch_count(const SearchSize& size)
{
    const std::uint32_t batch_tets = tets_of_batch(size);
    return (size.tets + batch_tets - 1) / batch_tets;
}

SearchRun recorded_search_run(const Options& options, const std::vector<RowRecord>& rows)
{
    SearchRun run;
    run.size = options.searches;
    run.batch_tets = tets_of_batch(run.size);
    run.shard = shard_of(options);
    run.threads = resolved_threads(options);
    for (const RowRecord& row : rows)
        run.rows.push_back(closed_row(row));
    run.images.resize(run.rows.size());
    return run;
}

SearchRun open_search_run(const Options& options, const std::vector<Backend*>& backends)
{
    SearchRun run = recorded_search_run(options, {});
    for (const RowKey& key : select_search_rows(options, backends)) {
        Packed& tets = run.tets[key.kernel.layout];
        if (tets.data.tet_count == 0) tets.data = search_tets(run.size.tets, key.kernel.layout);
        run.rows.push_back(open_row(key, tets, options, backends));
    }
    run.images.resize(run.rows.size());
    return run;
}

void run_searches(SearchRun& run, const Options& options, const Recording& shared)
{
    BatchRecorder recorder(run, options, shared);
    const std::size_t batches = run.shard.share(batch_count(run.size));
    if (const std::size_t restored = recorder.restore(); restored < batches && shared.budget->is_limited())
        shared.budget->plan_batches(run.rows, options.samples, options.sample_s, batches - restored,
                                    recorder.rays_of_batch(run.shard.part(0)).quads);
    const std::size_t done = recorder.run(batches, "exit searches");
    if (done == batches) return;
    run.batches_done = static_cast<std::uint32_t>(done);
    run.sampling = Sampling::chosen;
}

} // namespace tetrace
