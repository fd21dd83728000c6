#include "bench/rows/row_tracing.h"

#include "bench/rows/ray_store.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"
#include "core/device/host.h"
#include "core/device/launch.h"

#include <algorithm>

namespace tetrace {

namespace {

constexpr std::uint64_t max_batch_bytes = std::uint64_t{512} << 20;

/// The larger of a launch's output and its given rays.
std::uint64_t launch_bytes(const RowRun& row, const ViewBatch& views)
{
    std::vector<std::size_t> rays;
    for (const std::size_t view : views)
        rays.push_back(ray_count(row, view));
    const bool are_given = traits_of(row.key.kernel.task).takes_rays;
    if (are_given) rays = {ray_count(row, views)};
    const std::size_t sums = traits_of(row.key.kernel.task).tallies ? row.packed->data.tet_count : 0;
    const std::uint64_t output = OutputParts(rays, HIT_WORDS, 2 * sums).words() * sizeof(std::uint32_t);
    return are_given ? std::max<std::uint64_t>(output, GIVEN_RAY_QUADS * sizeof(Quad) * rays.front()) : output;
}

const std::vector<Quad>& quads_of(RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    return scene.given_rays().rows(scene, row.key, row.packed != nullptr ? &row.packed->data : nullptr, view);
}

/// All directions come first, then all origins (kernels/layouts/layout.h).
std::vector<Quad> joined_quads(RowRun& row, const ViewBatch& views)
{
    std::vector<Quad> all;
    for (std::size_t list = 0; list < GIVEN_RAY_QUADS; ++list)
        for (const std::size_t view : views) {
            const std::vector<Quad>& quads = quads_of(row, view);
            const auto rays = static_cast<std::ptrdiff_t>(quads.size() / GIVEN_RAY_QUADS);
            const auto first = quads.begin() + static_cast<std::ptrdiff_t>(list) * rays;
            all.insert(all.end(), first, first + rays);
        }
    return all;
}

} // namespace

std::size_t ray_count(const RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    if (!traits_of(row.key.kernel.task).takes_rays) return scene.rays_per_view();
    return scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view).rays.size();
}

std::uint64_t hash_of_rays(const RowRun& row)
{
    SceneWork& scene = *row.scene;
    std::vector<std::uint64_t> hashes;
    for (std::size_t view = 0; view < scene.views().size(); ++view)
        hashes.push_back(ray_hash(scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view)));
    return hash_of(hashes);
}

std::uint32_t pixel_of_ray(const RowRun& row, std::size_t view, std::size_t ray)
{
    SceneWork& scene = *row.scene;
    if (!traits_of(row.key.kernel.task).takes_rays) return static_cast<std::uint32_t>(ray);
    return scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view).rays[ray].pixel;
}

TraceJob job_of(const RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    if (!traits_of(row.key.kernel.task).takes_rays)
        return scene.job(view, row.packed != nullptr ? &row.packed->data : nullptr, row.device);
    const RaySet& set = scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view);
    return given_job(set.rays.size(), step_cap(scene.counts().tets, row.device), set.any_hit);
}

TraceJob prepare_view(RowRun& row, std::size_t view)
{
    return prepare_batch(row, {view}).front();
}

std::size_t last_view_with_rays(const RowRun& row)
{
    std::size_t view = row.scene->views().size() - 1;
    while (ray_count(row, view) == 0)
        --view;
    return view;
}

std::uint64_t batch_limit(const RowRun& row, std::size_t rows)
{
    std::uint64_t limit = max_batch_bytes;
    std::uint64_t memory = row.device.memory_bytes;
    if (row.device.kind == DeviceKind::emulated) // its driver does not know a container's limit
        memory = std::min(memory, host_device().memory_bytes);
    if (memory != 0) limit = std::min(limit, memory / 3 / rows);
    return row.max_buffer_bytes == 0 ? limit : std::min(limit, row.max_buffer_bytes);
}

std::vector<ViewBatch> joined_views(const RowRun& row, std::uint64_t limit_bytes)
{
    std::vector<ViewBatch> batches;
    for (const ViewBatch& view : single_views(row)) {
        ViewBatch joined = batches.empty() ? ViewBatch() : batches.back();
        joined.push_back(view.front());
        if (joined.size() > 1 && launch_bytes(row, joined) <= limit_bytes)
            batches.back() = std::move(joined);
        else
            batches.push_back(view);
    }
    return batches;
}

std::vector<ViewBatch> single_views(const RowRun& row)
{
    std::vector<ViewBatch> batches;
    for (std::size_t view = 0; view < row.scene->views().size(); ++view)
        if (ray_count(row, view) > 0) batches.push_back({view});
    return batches;
}

std::size_t ray_count(const RowRun& row, const ViewBatch& views)
{
    std::size_t rays = 0;
    for (const std::size_t view : views)
        rays += ray_count(row, view);
    return rays;
}

std::vector<TraceJob> prepare_batch(RowRun& row, const ViewBatch& views)
{
    std::vector<TraceJob> jobs;
    if (!traits_of(row.key.kernel.task).takes_rays) {
        for (const std::size_t view : views)
            jobs.push_back(job_of(row, view));
        return jobs;
    }
    if (row.views_of_rays != views) {
        row.views_of_rays.clear();
        if (views.size() == 1)
            row.session->set_rays(quads_of(row, views.front()));
        else
            row.session->set_rays(joined_quads(row, views));
        row.views_of_rays = views;
    }
    const TraceJob first = job_of(row, views.front());
    return {given_job(ray_count(row, views), first.max_steps, first.any_hit)};
}

double trace_view(RowRun& row, std::size_t view, std::span<Hit> hits)
{
    return row.session->trace(prepare_view(row, view), hits);
}

Clock host_clock()
{
    return [watch = Stopwatch()] { return watch.seconds(); };
}

LaunchTimes timed_launch(Session& session, std::span<const TraceJob> jobs, const Clock& clock,
                         const std::function<void()>& meanwhile)
{
    const double start_s = clock();
    session.launch(jobs);
    if (meanwhile) meanwhile();
    const double kernel_s = session.wait();
    return {kernel_s, clock() - start_s};
}

LaunchTimes timed_launch(Session& session, const TraceJob& job, const Clock& clock,
                         const std::function<void()>& meanwhile)
{
    return timed_launch(session, std::span(&job, 1), clock, meanwhile);
}

} // namespace tetrace
