#include "bench/rivals/contest.h"

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/rows/physical_device.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <tuple>

namespace tetrace {

namespace {

/// Where a row runs: its hardware, and the API too if that is emulated.
using DeviceKey = std::tuple<DeviceKind, std::size_t, std::string>;

/// Empty if nothing is known. A row whose scene could not be loaded has no device: openmp's and Embree's is the host's.
std::optional<DeviceKey> place_of(const RowRecord& row, std::size_t hardware)
{
    if (row.device.name.empty()) {
        if (!on_reference(row.key) && !is_embree(row.key.kernel.layout)) return std::nullopt;
        return DeviceKey{DeviceKind::cpu, std::numeric_limits<std::size_t>::max(), {}};
    }
    const bool is_emulated = row.device.kind == DeviceKind::emulated;
    return DeviceKey{row.device.kind, hardware, is_emulated ? device_label(row.key) : std::string()};
}

/// Adds the row's API unless it is there.
void add_device(Contest& contest, const RowRecord& row)
{
    const std::string label = device_label(row.key);
    if (std::ranges::any_of(contest.rows, [&](const RowRecord* other) { return device_label(other->key) == label; }))
        return;
    contest.device += (contest.device.empty() ? "" : ", ") + label;
}

} // namespace

std::vector<ContestScene> contest_scenes(const std::vector<nlohmann::json>& scenes)
{
    std::vector<ContestScene> found;
    for (const nlohmann::json& scene : scenes)
        found.push_back({scene.at("name"),
                         scene.at("tets_kind") == name_of(TetsKind::rays) ? TetsKind::rays : TetsKind::cdt,
                         scene.contains("own_views")});
    return found;
}

std::vector<Contest> contests_of(const std::vector<RowRecord>& rows, const std::vector<ContestScene>& scenes)
{
    std::vector<Device> devices;
    for (const RowRecord& row : rows)
        devices.push_back(row.device);
    const auto hardware = physical_devices(devices);
    std::vector<Contest> contests;
    std::vector<DeviceKey> places;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RowRecord& row = rows[i];
        const auto place = place_of(row, hardware[i]);
        if (!place || (is_portable(row.key.kernel) && row.key.kernel.math == MathMode::fast)) continue;
        std::size_t c = 0;
        while (c < contests.size() && (places[c] != *place || !same_rays(contests[c].rows.front()->key, row.key)))
            ++c;
        if (c == contests.size()) {
            contests.push_back({row.key.scene, row.key.rays, std::get<DeviceKind>(*place), {}, {}, {}});
            const auto scene = std::ranges::find(scenes, row.key.scene, &ContestScene::name);
            if (scene != scenes.end()) contests.back().facts = *scene;
            places.push_back(*place);
        }
        add_device(contests[c], row);
        contests[c].rows.push_back(&row);
    }
    return contests;
}

bool is_of(const RowRecord& row, Walk walk)
{
    const KernelId& kernel = row.key.kernel;
    if (kernel.structure != Structure::cdt) return false;
    switch (walk) {
    case Walk::half32:
        return kernel.method == Method::project && kernel.layout == Layout::half32 && is_single_ray(kernel);
    case Walk::tet64:
        return kernel.method == Method::project && kernel.layout == Layout::tet64 && is_single_ray(kernel);
    case Walk::maria: return kernel.method == Method::maria && is_single_ray(kernel);
    case Walk::packets: return kernel.schedule == Schedule::packets;
    case Walk::single: return is_single_ray(kernel);
    case Walk::any: return true;
    }
    return false;
}

bool is_of(const RowRecord& row, Rival rival)
{
    const KernelId& kernel = row.key.kernel;
    if (kernel.structure != Structure::bvh) return false;
    switch (rival) {
    case Rival::our_single: return is_portable(kernel) && is_single_ray(kernel);
    case Rival::embree_single: return is_embree(kernel.layout) && kernel.method == Method::single;
    case Rival::embree: return is_embree(kernel.layout);
    case Rival::single: return is_single_ray(kernel);
    case Rival::any: return true;
    }
    return false;
}

const RowRecord* fastest(const std::vector<const RowRecord*>& rows)
{
    const RowRecord* found = nullptr;
    double rate = 0;
    for (const RowRecord* row : rows)
        if (const auto figures = figures_of(*row); figures && figures->mrays_per_s > rate) {
            found = row;
            rate = figures->mrays_per_s;
        }
    return found;
}

Estimate rate_ratio(const RowRecord& row, const RowRecord& over)
{
    const Comparison comparison = compare_rates(over, row);
    Estimate estimate{comparison.ratio, {}, {}};
    if (comparison.interval) {
        estimate.low = comparison.interval->low;
        estimate.high = comparison.interval->high;
    }
    return estimate;
}

std::string title_of(const Contest& contest)
{
    return contest.rays == RayKind::primary ? contest.scene
                                            : fmt::format("{}, {} rays", contest.scene, name_of(contest.rays));
}

std::string rated_label(const RowRecord& row)
{
    const Figures figures = *figures_of(row);
    std::string remarks;
    if (status_of(row) == Status::flawed) remarks += ", flawed";
    if (figures.noisy) remarks += ", noisy";
    return fmt::format("{} ({:.4g} Mrays/s{})", row_label(row.key), figures.mrays_per_s, remarks);
}

} // namespace tetrace
