#include "bench/rows/row_tracing.h"

#include "bench/rows/ray_store.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"

namespace tetrace {

std::size_t ray_count(const RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    if (row.key.kernel.task == Task::trace) return scene.rays_per_view();
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
    if (row.key.kernel.task == Task::trace) return static_cast<std::uint32_t>(ray);
    return scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view).rays[ray].pixel;
}

TraceJob job_of(const RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    if (row.key.kernel.task == Task::trace)
        return scene.job(view, row.packed != nullptr ? &row.packed->data : nullptr, row.device);
    const RaySet& set = scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view);
    return given_job(set.rays.size(), step_cap(scene.counts().tets, row.device), set.any_hit);
}

TraceJob prepare_view(RowRun& row, std::size_t view)
{
    if (row.key.kernel.task == Task::rays && row.view_of_rays != view) {
        SceneWork& scene = *row.scene;
        row.view_of_rays.reset();
        row.session->set_rays(
            scene.given_rays().rows(scene, row.key, row.packed != nullptr ? &row.packed->data : nullptr, view));
        row.view_of_rays = view;
    }
    return job_of(row, view);
}

std::size_t last_view_with_rays(const RowRun& row)
{
    std::size_t view = row.scene->views().size() - 1;
    while (ray_count(row, view) == 0)
        --view;
    return view;
}

double trace_view(RowRun& row, std::size_t view, std::span<Hit> hits)
{
    return row.session->trace(prepare_view(row, view), hits);
}

Clock host_clock()
{
    return [watch = Stopwatch()] { return watch.seconds(); };
}

LaunchTimes timed_launch(Session& session, const TraceJob& job, const Clock& clock,
                         const std::function<void()>& meanwhile)
{
    const double start_s = clock();
    session.launch(job);
    if (meanwhile) meanwhile();
    const double kernel_s = session.wait();
    return {kernel_s, clock() - start_s};
}

} // namespace tetrace
