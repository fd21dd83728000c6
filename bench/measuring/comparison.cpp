#include "bench/measuring/comparison.h"

#include "bench/measuring/figures.h"
#include "bench/rows/physical_device.h"
#include "bench/statistics/median_ratio.h"

#include <algorithm>

namespace tetrace {

namespace {

/// The API that a GPU's other APIs are compared with, where it has the row.
constexpr const char* preferred_on_gpus = "cuda";

std::vector<std::size_t> hardware_of(const std::vector<RowRun>& rows)
{
    std::vector<Device> devices;
    for (const RowRun& row : rows)
        devices.push_back(row.device);
    return physical_devices(devices);
}

/// The row's reference, which may be the row itself; null where there is none.
const RowRun* find_reference(const std::vector<RowRun>& rows, const std::vector<std::size_t>& hardware,
                             std::size_t index)
{
    const RowRun& row = rows[index];
    const bool on_host = runs_on_host(row.device);
    const std::string preferred = on_host ? reference_backend().name() : preferred_on_gpus;
    const RowRun* first = nullptr;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RowRun& other = rows[i];
        if (hardware[i] != hardware[index] || !same_work(row.key, other.key) ||
            other.key.kernel.schedule != Schedule::tiles || !figures_of(other))
            continue;
        if (other.key.backend == preferred) return &other;
        if (first == nullptr && !on_host) first = &other;
    }
    return first;
}

Comparison compared(const RowRun& reference, const RowRun& row)
{
    const MedianRatio rate = ratio_of_medians(reference.samples_s, row.samples_s);
    Comparison comparison{&reference, rate.value, {}};
    if (std::min(reference.samples_s.size(), row.samples_s.size()) >= fewest_samples)
        comparison.interval = FactorInterval{rate.low, rate.high};
    return comparison;
}

} // namespace

std::vector<std::optional<Comparison>> compare_rows(const std::vector<RowRun>& rows)
{
    const auto hardware = hardware_of(rows);
    std::vector<std::optional<Comparison>> result(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!is_portable(rows[i].key.kernel) || !figures_of(rows[i])) continue;
        const RowRun* reference = find_reference(rows, hardware, i);
        if (reference == nullptr || reference == &rows[i]) continue;
        result[i] = compared(*reference, rows[i]);
    }
    return result;
}

} // namespace tetrace
