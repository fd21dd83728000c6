#include "bench/row_tracing.h"

#include "bench/ray_store.h"

namespace tetrace {

std::size_t ray_count(const RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    if (row.key.kernel.task == Task::trace) return scene.rays_per_view();
    return scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view).rays.size();
}

std::uint32_t pixel_of_ray(const RowRun& row, std::size_t view, std::size_t ray)
{
    SceneWork& scene = *row.scene;
    if (row.key.kernel.task == Task::trace) return static_cast<std::uint32_t>(ray);
    return scene.given_rays().set(scene, row.key.rays, row.key.ray_order, view).rays[ray].pixel;
}

TraceJob prepare_view(RowRun& row, std::size_t view)
{
    SceneWork& scene = *row.scene;
    const PackedScene* const packed = row.packed != nullptr ? &row.packed->scene : nullptr;
    if (row.key.kernel.task == Task::trace) return scene.job(view, packed);
    RayStore& store = scene.given_rays();
    if (row.view_of_rays != view) {
        row.view_of_rays.reset();
        row.session->set_rays(store.rows(scene, row.key, packed, view));
        row.view_of_rays = view;
    }
    const RaySet& set = store.set(scene, row.key.rays, row.key.ray_order, view);
    return given_job(set.rays.size(), scene.max_steps(), set.any_hit);
}

double trace_view(RowRun& row, std::size_t view, std::span<Hit> hits)
{
    row.session->launch(prepare_view(row, view));
    const double seconds = row.session->wait();
    row.session->read_back(hits);
    return seconds;
}

} // namespace tetrace
