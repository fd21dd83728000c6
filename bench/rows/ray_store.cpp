#include "bench/rows/ray_store.h"

#include "bench/rows/scene_work.h"
#include "core/base/error.h"
#include "core/device/given_quads.h"
#include "core/rays/ray_order.h"

namespace tetrace {

namespace {

/// The kernel that traces the primary hits from which other rays are made; through a BVH for a scene without tets.
KernelId reference_kernel(const SceneWork& scene)
{
    if (!scene.loaded().no_tets) return {};
    return {.structure = Structure::bvh, .method = Method::single, .layout = Layout::bvh2};
}

/// What it traces.
const PackedScene& reference_scene(SceneWork& scene)
{
    return scene.packed(reference_kernel(scene).layout, TetOrder::chains).data;
}

} // namespace

const std::vector<Hit>& RayStore::primary_hits(SceneWork& scene, std::size_t view)
{
    const auto [entry, is_new] = primary_hits_.try_emplace(view);
    if (!is_new) return entry->second;
    const PackedScene& packed = reference_scene(scene);
    const auto session = reference_backend().open(0, reference_kernel(scene), {&scene.loaded().scene.mesh, &packed},
                                                  {.threads = scene.threads()});
    entry->second.resize(scene.rays_per_view());
    static_cast<void>(session->trace(scene.job(view, &packed), entry->second));
    return entry->second;
}

const RaySet& RayStore::set(SceneWork& scene, RayKind kind, RayOrder order, std::size_t view)
{
    const auto [entry, is_new] = sets_.try_emplace({kind, order, view});
    if (!is_new) return entry->second;
    if (order != RayOrder::tiles) {
        entry->second = set(scene, kind, RayOrder::tiles, view);
        arrange(entry->second, order);
        return entry->second;
    }
    const bool needs_hits = kind != RayKind::primary && kind != RayKind::random;
    const auto mesh_of_packed =
        needs_hits ? inverse_of(reference_scene(scene).packed_of_mesh) : std::vector<std::uint32_t>();
    const RaySource source{scene.loaded().scene,
                           scene.view_numbers()[view],
                           scene.views()[view],
                           scene.width(),
                           scene.height(),
                           scene.start_tet(view),
                           needs_hits ? std::span<const Hit>(primary_hits(scene, view)) : std::span<const Hit>(),
                           mesh_of_packed};
    entry->second = make_rays(kind, source);
    return entry->second;
}

const std::vector<Quad>& RayStore::rows(SceneWork& scene, const RowKey& key, const PackedScene* packed,
                                        std::size_t view)
{
    const SetKey set_key{key.rays, key.ray_order, view};
    const auto [entry, is_new] = rows_.try_emplace({set_key, key.kernel.task, key.kernel.structure, key.order});
    if (!is_new) return entry->second;
    const RaySet& rays = set(scene, key.rays, key.ray_order, view);
    if (traits_of(key.kernel.task).crosses)
        entry->second = segment_quads(rays, *packed);
    else
        entry->second = key.kernel.structure == Structure::cdt ? given_quads(rays, *packed)
                                                               : given_quads_offset(rays, scene.loaded().scene.mesh);
    return entry->second;
}

} // namespace tetrace
