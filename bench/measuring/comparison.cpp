#include "bench/measuring/comparison.h"

#include "bench/measuring/figures.h"
#include "bench/rows/physical_device.h"
#include "bench/statistics/break_even.h"
#include "bench/statistics/rank_interval.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <tuple>

namespace tetrace {

namespace {

std::vector<std::size_t> hardware_of(const std::vector<RowRecord>& rows)
{
    std::vector<Device> devices;
    for (const RowRecord& row : rows)
        devices.push_back(row.device);
    return physical_devices(devices);
}

/// The row's reference, which may be the row itself; null if there is none.
const RowRecord* find_reference(const std::vector<RowRecord>& rows, const std::vector<std::size_t>& hardware,
                                std::size_t index)
{
    const RowRecord& row = rows[index];
    const bool on_host = runs_on_host(row.device);
    const std::string preferred = reference_name(on_host ? DeviceKind::cpu : DeviceKind::gpu);
    const RowRecord* first = nullptr;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RowRecord& other = rows[i];
        if (hardware[i] != hardware[index] || !same_work(row.key, other.key) || !same_load(row.key, other.key) ||
            other.key.kernel.schedule != Schedule::tiles || !figures_of(other))
            continue;
        if (other.key.backend == preferred) return &other;
        if (first == nullptr && !on_host) first = &other;
    }
    return first;
}

std::size_t min_in_run(const std::vector<std::vector<double>>& runs)
{
    return std::ranges::min(runs, {}, &std::vector<double>::size).size();
}

} // namespace

Comparison compare_rates(const RowRecord& reference, const RowRecord& row)
{
    const auto above = samples_of_runs(reference), below = samples_of_runs(row);
    const bool spans_runs = above.size() > 1 && above.size() == below.size();
    const MedianRatio rate =
        spans_runs ? ratio_over_runs(above, below) : ratio_of_medians(reference.samples_s, row.samples_s);
    Comparison comparison{&reference, rate.value, {}, spans_runs ? above.size() : 1};
    if (std::min(min_in_run(above), min_in_run(below)) >= min_samples)
        comparison.interval = FactorInterval{rate.low, rate.high};
    return comparison;
}

std::string interval_text(const Comparison& comparison)
{
    const auto& interval = comparison.interval;
    return interval ? fmt::format("[{:.2f}, {:.2f}]", interval->low, interval->high) : "";
}

namespace {

/// The device of a contest: its hardware, and the API too if that is emulated; how many threads use it, and how many
/// launches are in flight on it.
using DevicePlace = std::tuple<DeviceKind, std::size_t, std::string, unsigned, unsigned>;

/// Empty if nothing is known. A row whose scene could not be loaded has no device.
std::optional<DevicePlace> place_of(const RowRecord& row, std::size_t hardware)
{
    const RowKey& key = row.key;
    if (row.device.name.empty()) {
        if (!on_reference(key) && !is_embree(key.kernel.layout)) return std::nullopt;
        return DevicePlace{DeviceKind::cpu, std::numeric_limits<std::size_t>::max(), {}, key.threads, key.in_flight};
    }
    const bool is_emulated = row.device.kind == DeviceKind::emulated;
    return DevicePlace{row.device.kind, hardware, is_emulated ? device_label(key) : std::string(), key.threads,
                       key.in_flight};
}

TotalCost total_cost(const SetupCost& cost, double mrays_per_s)
{
    return {cost.once_s(), 1e-6 / mrays_per_s};
}

} // namespace

std::optional<double> mrays_of(const RowRecord& row)
{
    const auto figures = figures_of(row);
    return figures ? std::optional(figures->mrays_per_s) : std::nullopt;
}

std::vector<Contest<RowRecord>> contests_of(const std::vector<const RowRecord*>& rows)
{
    std::vector<Device> devices;
    for (const RowRecord* row : rows)
        devices.push_back(row->device);
    const auto hardware = physical_devices(devices);
    std::vector<const RowRecord*> placed;
    std::map<const RowRecord*, DevicePlace> places;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (const auto place = place_of(*rows[i], hardware[i])) {
            placed.push_back(rows[i]);
            places.emplace(rows[i], *place);
        }
    return contests_of(placed, [&](const RowRecord& a, const RowRecord& b) {
        return places.at(&a) == places.at(&b) && same_rays(a.key, b.key);
    });
}

std::vector<Contest<RowRecord>> contests_of(const std::vector<RowRecord>& rows)
{
    std::vector<const RowRecord*> all;
    for (const RowRecord& row : rows)
        all.push_back(&row);
    return contests_of(all);
}

std::vector<std::optional<Comparison>> compare_with_best_bvh(const std::vector<RowRecord>& rows)
{
    std::vector<std::optional<Comparison>> result(rows.size());
    for (const auto& contest : contests_of(rows))
        if (const RowRecord* const bvh = contest.fastest(Rival::any))
            for (const RowRecord* row : contest.rows)
                if (figures_of(*row))
                    result[static_cast<std::size_t>(row - rows.data())] =
                        row == bvh ? Comparison{bvh, 1, {}} : compare_rates(*bvh, *row);
    return result;
}

std::optional<PaidBuild> paid_build(const RowRecord& row, const std::optional<Comparison>& best_bvh)
{
    if (!best_bvh || row.key.kernel.structure != Structure::cdt) return std::nullopt;
    const auto tets = setup_cost(row), bvh = setup_cost(*best_bvh->reference);
    if (!tets || !bvh) return std::nullopt;
    if (best_bvh->interval && best_bvh->interval->contains(1)) return PaidBuild{PaidBuild::When::unclear};
    const TotalCost ours = total_cost(*tets, figures_of(row)->mrays_per_s);
    const BreakEven even = break_even(ours, total_cost(*bvh, figures_of(*best_bvh->reference)->mrays_per_s));
    if (even.ahead != BreakEven::Ahead::first) return PaidBuild{PaidBuild::When::never};
    if (!even.rays) return PaidBuild{PaidBuild::When::at_once};
    return PaidBuild{PaidBuild::When::later, *even.rays, *even.rays * ours.ray_s};
}

std::vector<std::optional<Comparison>> compare_rows(const std::vector<RowRecord>& rows)
{
    const auto hardware = hardware_of(rows);
    std::vector<std::optional<Comparison>> result(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!is_portable(rows[i].key.kernel) || !figures_of(rows[i])) continue;
        const RowRecord* reference = find_reference(rows, hardware, i);
        if (reference == nullptr || reference == &rows[i]) continue;
        result[i] = compare_rates(*reference, rows[i]);
    }
    return result;
}

} // namespace tetrace
