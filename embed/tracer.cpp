#include "embed/tracer.h"

#include "backends/embree/bvh_builder.h"
#include "core/base/cache_home.h"
#include "core/base/error.h"
#include "core/device/given_quads.h"
#include "core/pack/pack_bvh.h"
#include "embed/placed_rays.h"

#include <algorithm>
#include <omp.h>
#include <string>
#include <vector>

namespace tetrace {

namespace {

constexpr std::size_t rays_per_launch = std::size_t{1} << 20; // 32 MB of rays

bool is_of_library(const KernelId& kernel)
{
    if (kernel.schedule != Schedule::tiles) return false;
    return kernel.layout == Layout::rt || (is_portable(kernel) && kernel.math == MathMode::exact &&
                                           (kernel.structure == Structure::bvh || kernel.method == Method::project));
}

/// Those for given rays, in the order of the list: ours, through tets by `project`, which is never lost; and a
/// driver's.
std::vector<KernelId> library_kernels()
{
    std::vector<KernelId> kernels = kernels_of(Task::rays);
    std::erase_if(kernels, [](const KernelId& kernel) { return !is_of_library(kernel); });
    return kernels;
}

KernelId kernel_of(std::string_view layout)
{
    std::string names;
    for (const KernelId& kernel : library_kernels()) {
        if (name_of(kernel.layout) == layout) return kernel;
        names += (names.empty() ? "" : ", ") + std::string(name_of(kernel.layout));
    }
    throw Error(ErrorKind::usage, "opening a device: layout '" + std::string(layout) + "' is not one of " + names);
}

Backend& backend_of(std::string_view name)
{
    if (Backend* const found = find_backend(name)) return *found;
    std::string names;
    for (const Backend* const backend : all_backends())
        names += (names.empty() ? "" : ", ") + backend->name();
    throw Error(ErrorKind::usage, "opening a device: backend '" + std::string(name) + "' is not one of " + names);
}

/// With instructions of this processor if there is such code: the same bits, sooner.
KernelId fastest(const KernelId& kernel, const Backend& backend, std::uint32_t device)
{
    KernelId native = kernel;
    native.schedule = Schedule::native;
    return backend.has_kernel(native) && backend.why_not(device, native).empty() ? native : kernel;
}

std::filesystem::path compiled_programs()
{
    const std::filesystem::path home = cache_home();
    return home.empty() ? home : home / "tetrace" / "programs";
}

} // namespace

bool traces_given_rays(const Backend& backend)
{
    return std::ranges::any_of(library_kernels(), [&](const KernelId& kernel) { return backend.has_kernel(kernel); });
}

Tracer::Tracer(std::shared_ptr<const LoadedScene> scene, std::string_view backend, std::uint32_t device,
               std::string_view layout)
    : scene_(std::move(scene))
{
    KernelId kernel = kernel_of(layout);
    Backend& api = backend_of(backend);
    if (device >= api.devices().size())
        throw Error(ErrorKind::usage, "opening a device: " + api.name() + " has " +
                                          std::to_string(api.devices().size()) + " devices, numbered from 0, and not " +
                                          std::to_string(device));
    device_ = &api.devices()[device];
    if (!device_->usable) throw Error(ErrorKind::missing, "opening a device: " + api.name() + ": " + device_->reason);
    if (kernel.structure == Structure::cdt && scene_->no_tets) throw Error(*scene_->no_tets);
    structure_ = kernel.structure;
    if (kernel.layout != Layout::rt) packed_ = packed(kernel.layout);
    kernel = fastest(kernel, api, device);
    SessionOptions options;
    options.program_cache = compiled_programs();
    session_ = api.open(device, kernel, {&scene_->scene.mesh, &packed_}, options);
}

PackedScene Tracer::packed(Layout layout) const
{
    const Scene& scene = scene_->scene;
    if (structure_of(layout) == Structure::cdt) return pack(scene, layout, TetOrder::chains);
    return pack_bvh(scene.mesh, build_bvh(scene.mesh).bvh, layout);
}

void Tracer::trace(std::span<const tetrace_ray> rays, bool any_hit, std::span<tetrace_hit> hits)
{
    std::vector<tetrace_hit> found(rays.size());
    for (std::size_t first = 0; first < rays.size(); first += rays_per_launch) {
        const std::size_t count = std::min(rays_per_launch, rays.size() - first);
        trace_launch(rays.subspan(first, count), first, any_hit, std::span(found).subspan(first, count));
    }
    std::ranges::copy(found, hits.begin());
}

void Tracer::trace_launch(std::span<const tetrace_ray> rays, std::size_t first, bool any_hit,
                          std::span<tetrace_hit> hits)
{
    const PlacedRays placed(scene_->scene, structure_, rays, first, static_cast<unsigned>(omp_get_max_threads()));
    const RaySet& set = placed.set();
    session_->set_rays(given_quads(set, packed_));
    std::vector<Hit> found(set.rays.size());
    const TraceJob job = given_job(found.size(), step_cap(scene_->scene.tets.tets.size(), *device_), any_hit);
    static_cast<void>(session_->trace(job, found));
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = placed.hit_of(i, found[i]);
}

} // namespace tetrace
