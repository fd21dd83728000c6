#include "backends/cuda/yardstick.h"
#include "core/device/yardstick.h"

#include <algorithm>

namespace tetrace::cuda {

namespace {

constexpr std::size_t least_bytes = std::size_t{64} << 20, most_bytes = std::size_t{512} << 20;
constexpr double enough_s = 5e-3; // much longer than a launch and the clock's resolution
constexpr int passes = 8;

double copy_s(OpenDevice& device, const Memory& from, const Memory& to)
{
    EventTimer timer(device.context);
    double best_s = 1e300;
    for (int pass = 0; pass < passes; ++pass) {
        timer.start(device.stream.get());
        device.context.check(
            device.driver().copy_on_device(to.address(), from.address(), from.bytes(), device.stream.get()),
            "copying memory to memory");
        timer.stop(device.stream.get());
        const double seconds = timer.seconds();
        if (pass > 0) best_s = std::min(best_s, seconds); // the first one may touch pages
    }
    return best_s;
}

double copy_bytes_per_s(OpenDevice& device)
{
    std::size_t free = 0, total = 0;
    device.context.check(device.driver().memory_info(&free, &total), "asking how much memory is free");
    for (std::size_t bytes = std::min(least_bytes, free / 4);; bytes *= 2) {
        const Memory from(device.context, bytes, "the copy's source"), to(device.context, bytes, "the copy's target");
        const double seconds = copy_s(device, from, to);
        if (seconds >= enough_s || 2 * bytes > std::min(most_bytes, free / 4))
            return 2.0 * static_cast<double>(bytes) / seconds;
    }
}

double launch_s(OpenDevice& device, FunctionHandle probe)
{
    Address none = 0;
    std::uint32_t count = 0;
    void* parameters[] = {&none, &none, &count};
    return median_seconds([&] {
        device.launch(probe, 1, 1, parameters);
        device.synchronize();
    });
}

} // namespace

Yardstick measure_device(OpenDevice& device, FunctionHandle probe)
{
    return {copy_bytes_per_s(device), launch_s(device, probe)};
}

} // namespace tetrace::cuda
