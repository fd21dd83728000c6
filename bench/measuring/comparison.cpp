#include "bench/measuring/comparison.h"

#include "bench/measuring/figures.h"
#include "bench/rows/physical_device.h"
#include "bench/statistics/break_even.h"
#include "bench/statistics/rank_interval.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// The API that a GPU's other APIs are compared with, if it has the row.
constexpr const char* preferred_on_gpus = "cuda";

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
    const std::string preferred = on_host ? reference_backend().name() : preferred_on_gpus;
    const RowRecord* first = nullptr;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RowRecord& other = rows[i];
        if (hardware[i] != hardware[index] || !same_work(row.key, other.key) ||
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

std::string arena_of(const RowRecord& row, std::size_t hardware)
{
    const RowKey& key = row.key;
    const std::string device = row.device.kind == DeviceKind::emulated ? fmt::format("{}:{}", key.backend, key.device)
                                                                       : fmt::format("{} {}", hardware, key.threads);
    return fmt::format("{} {} {} {}", key.scene, name_of(key.rays), name_of(key.ray_order), device);
}

TotalCost total_cost(const SetupCost& cost, double mrays_per_s)
{
    return {cost.once_s(), 1e-6 / mrays_per_s};
}

} // namespace

Contenders contenders_of(const std::vector<RowRecord>& rows)
{
    const auto hardware = hardware_of(rows);
    Contenders found;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto figures = figures_of(rows[i]);
        if (!figures) continue;
        const KernelId& kernel = rows[i].key.kernel;
        found.list.push_back({row_label(rows[i].key), arena_of(rows[i], hardware[i]),
                              kernel.structure == Structure::bvh, is_embree(kernel.layout), is_single_ray(kernel),
                              figures->mrays_per_s});
        found.index.push_back(i);
    }
    return found;
}

std::vector<std::optional<Comparison>> compare_with_best_bvh(const std::vector<RowRecord>& rows)
{
    const Contenders contenders = contenders_of(rows);
    std::vector<std::optional<Comparison>> result(rows.size());
    for (std::size_t i = 0; i < contenders.list.size(); ++i) {
        const auto best = best_bvh(contenders.list, i);
        if (!best) continue;
        const RowRecord& bvh = rows[contenders.index[*best]];
        result[contenders.index[i]] =
            *best == i ? Comparison{&bvh, 1, {}} : compare_rates(bvh, rows[contenders.index[i]]);
    }
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
