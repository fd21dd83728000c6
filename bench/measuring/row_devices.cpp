#include "bench/measuring/row_devices.h"

#include "bench/measuring/figures.h"
#include "bench/rows/physical_device.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

namespace tetrace {

namespace {

void number_hardware(std::vector<RowDevice>& devices)
{
    std::vector<Device> plain;
    for (const RowDevice& device : devices)
        plain.push_back(device.device);
    const auto hardware = physical_devices(plain);
    for (std::size_t i = 0; i < devices.size(); ++i)
        devices[i].hardware = hardware[i];
}

void add_problem(RowDevice& device, const char* what, const std::exception& error)
{
    append_item(device.problem, "; ", fmt::format("{}: {}", what, error.what()));
}

/// Does a part of the work on a device; a failure becomes the device's problem.
template <class Work>
void attempt(RowDevice& device, const char* what, const Work& work)
{
    try {
        work();
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        add_problem(device, what, error);
    } catch (const std::exception& error) { // out of memory: must not lose the samples of all rows
        add_problem(device, what, error);
    }
}

void measure_device(RowDevice& device, Backend& backend, const SessionOptions& options)
{
    attempt(device, "microbenchmark", [&] {
        if (device.yardstick) return;
        device.yardstick = yardstick_of(backend, device.index, options);
        if (!device.yardstick && runs_on_host(device.device))
            device.yardstick = yardstick_of(reference_backend(), 0, options);
    });
    for (const MathMode math : device.math)
        attempt(device, "self-test", [&] {
            if (const auto& test = self_test_of(backend, device.index, math)) device.self_tests[math] = *test;
        });
}

} // namespace

std::optional<std::size_t> device_of(const RowRecord& row, const std::vector<RowDevice>& devices)
{
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (devices[i].backend == row.key.backend && devices[i].index == row.key.device) return i;
    return std::nullopt;
}

std::vector<RowDevice> devices_of(const std::vector<RowRecord>& rows)
{
    std::vector<RowDevice> devices;
    for (const RowRecord& row : rows) {
        if (row.device.name.empty() || !row.device.usable) continue;
        auto found = device_of(row, devices);
        if (!found) {
            found = devices.size();
            devices.push_back({row.key.backend, row.key.device, row.device, 0, {}, {}, {}, {}});
        }
        auto& math = devices[*found].math;
        if (std::ranges::find(math, row.key.kernel.math) == math.end()) math.push_back(row.key.kernel.math);
    }
    number_hardware(devices);
    std::ranges::stable_sort(devices, [](const RowDevice& a, const RowDevice& b) {
        return std::tuple(a.hardware, a.device.kind == DeviceKind::emulated) <
               std::tuple(b.hardware, b.device.kind == DeviceKind::emulated);
    });
    return devices;
}

void measure_devices(std::vector<RowDevice>& devices, const SessionOptions& options,
                     const std::vector<Backend*>& backends)
{
    for (RowDevice& device : devices) {
        const double done = static_cast<double>(&device - devices.data()) / static_cast<double>(devices.size());
        progress_line().show("measuring the devices themselves", done, -1, device.backend);
        measure_device(device, backend_named(device.backend, backends), options);
    }
    progress_line().clear();
}

std::optional<CopyShares> copy_shares(const RowRecord& row, const std::vector<RowDevice>& devices)
{
    const auto figures = figures_of(row);
    const auto place = device_of(row, devices);
    if (!figures || !figures->gb_per_s || row.key.threads != 0 || !place || !devices[*place].yardstick)
        return std::nullopt;
    const Yardstick& yardstick = *devices[*place].yardstick;
    const double bytes_per_s = 1e9 * *figures->gb_per_s;
    const double ceiling = yardstick.copy_bytes_per_s_of(row.setup.bytes.value_or(0));
    return CopyShares{bytes_per_s / yardstick.copy_bytes_per_s, bytes_per_s / ceiling, ceiling};
}

} // namespace tetrace
