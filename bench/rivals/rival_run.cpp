#include "bench/rivals/rival_run.h"

#include "bench/measuring/scene_rows.h"
#include "bench/rivals/rival_claims.h"
#include "bench/rows/physical_device.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const RivalScene* find_scene(const std::string& label)
{
    const auto found =
        std::ranges::find_if(rival_scenes(), [&](const RivalScene& scene) { return is_scene(label, scene.name); });
    return found == rival_scenes().end() ? nullptr : &*found;
}

bool has_rays(const RivalScene* scene, RayKind rays)
{
    if (scene != nullptr && scene->has_all_rays) return true;
    return rays == RayKind::primary || rays == RayKind::diffuse || rays == RayKind::random;
}

bool is_wanted(const RowKey& key, const Options& options)
{
    const RivalScene* const scene = find_scene(key.scene);
    if (!has_rays(scene, key.rays)) return false;
    const bool is_emulated = backend_named(key.backend).devices().at(key.device).kind == DeviceKind::emulated;
    if (is_emulated && (key.rays != RayKind::primary || (scene != nullptr && !scene->has_all_rays))) return false;
    const bool is_other_tree = is_embree(key.kernel.layout) && key.kernel.layout != Layout::embree;
    if (is_other_tree && options.layouts.empty())
        return key.rays == RayKind::primary && (scene == nullptr || scene->has_all_rays);
    if (key.kernel.method != Method::maria || !options.methods.empty()) return true;
    return !is_emulated && key.rays == RayKind::primary &&
           (key.kernel.layout == Layout::tet80 || !options.layouts.empty());
}

bool is_kept_backend(const Options& options, const Backend& backend)
{
    return options.backends.empty() || std::ranges::find(options.backends, backend.name()) != options.backends.end();
}

/// The same kernel in its form for AVX2; a row of another backend has none.
void add_native(std::vector<RowKey>& rows, RowKey key)
{
    if (!on_reference(key) || key.kernel.schedule != Schedule::tiles) return;
    key.kernel.schedule = Schedule::native;
    if (backend_named(key.backend).has_kernel(key.kernel)) rows.push_back(std::move(key));
}

} // namespace

Options rival_options(Options options, std::vector<std::string>& missing)
{
    if (!options.scenes.empty()) return options;
    for (const RivalScene& scene : rival_scenes()) {
        const std::string name(scene.name), reason = why_not_available(name);
        if (reason.empty())
            options.scenes.push_back(name);
        else
            missing.push_back(fmt::format("{} is left out: {}", name, reason));
    }
    return options;
}

std::vector<RowKey> rival_rows(const Options& options)
{
    Options selecting = options;
    selecting.verb = Verb::bench; // whose defaults have packets
    selecting.rays = values_of<RayKind>();
    std::vector<RowKey> rows;
    for (const RowKey& key : selected_rows(selecting, [](const std::string&) { return true; }))
        if (is_wanted(key, options)) {
            rows.push_back(key);
            add_native(rows, key);
        }
    return rows;
}

LeftOut left_out(const Options& options, const std::vector<Backend*>& backends)
{
    const bool wants_exact = std::ranges::find(options.math, MathMode::exact) != options.math.end();
    LeftOut left_out;
    left_out.kernels = !options.methods.empty() || !options.layouts.empty() || !options.schedules.empty() ||
                       !options.orders.empty() || (!options.math.empty() && !wants_exact);
    std::vector<Device> gpus;
    std::vector<bool> is_kept;
    for (const Backend* backend : backends)
        for (std::size_t i = 0; i < backend->devices().size(); ++i) {
            const Device& device = backend->devices()[i];
            if (!device.usable || device.kind != DeviceKind::gpu) continue;
            gpus.push_back(device);
            is_kept.push_back(is_kept_backend(options, *backend) && wanted_device(options, *backend, i));
        }
    const auto hardware = physical_devices(gpus);
    for (std::size_t i = 0; i < gpus.size(); ++i)
        for (std::size_t j = 0; j < gpus.size(); ++j)
            if (hardware[i] == hardware[j] && is_kept[i] && !is_kept[j]) left_out.apis = true;
    return left_out;
}

} // namespace tetrace
