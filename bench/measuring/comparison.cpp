#include "bench/measuring/comparison.h"

#include "bench/measuring/figures.h"
#include "bench/rows/physical_device.h"

namespace tetrace {

namespace {

std::vector<std::size_t> hardware_of(const std::vector<RowRun>& rows)
{
    std::vector<Device> devices;
    for (const RowRun& row : rows)
        devices.push_back(row.device);
    return physical_devices(devices);
}

/// Whether `other` is the same work as the row, as its reference would do it.
bool does_the_same(const RowKey& row, const RowKey& other)
{
    KernelId kernel = row.kernel;
    kernel.schedule = Schedule::tiles;
    return other.kernel == kernel && other.scene == row.scene && other.rays == row.rays && other.order == row.order;
}

/// The row's reference, which may be itself; null where there is none.
const RowRun* find_reference(const std::vector<RowRun>& rows, const std::vector<std::size_t>& hardware,
                             std::size_t index)
{
    const RowRun& row = rows[index];
    const bool on_host = runs_on_host(row.device);
    const char* const preferred = on_host ? "openmp" : "cuda";
    const RowRun* first = nullptr;
    for (std::size_t i = 0; i < rows.size(); i++) {
        if (hardware[i] != hardware[index] || !does_the_same(row.key, rows[i].key) || !figures_of(rows[i])) continue;
        if (rows[i].key.backend == preferred) return &rows[i];
        if (first == nullptr && !on_host) first = &rows[i];
    }
    return first;
}

} // namespace

std::vector<std::optional<Comparison>> compare_rows(const std::vector<RowRun>& rows)
{
    const auto hardware = hardware_of(rows);
    std::vector<std::optional<Comparison>> result(rows.size());
    for (std::size_t i = 0; i < rows.size(); i++) {
        if (!is_portable(rows[i].key.kernel) || !figures_of(rows[i])) continue;
        const RowRun* reference = find_reference(rows, hardware, i);
        if (reference == nullptr || reference == &rows[i]) continue;
        result[i] = Comparison{reference, ratio_of_medians(reference->samples_s, rows[i].samples_s)};
    }
    return result;
}

} // namespace tetrace
