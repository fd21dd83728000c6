#include "backends/cuda/yardstick.h"
#include "core/device/yardstick.h"

namespace tetrace::cuda {

namespace {

Yardstick measured_copies(OpenDevice& device)
{
    std::size_t free = 0, total = 0;
    device.context.check(device.driver().memory_info(&free, &total), "asking how much memory is free");
    const std::size_t bytes = copied_bytes(free, 0);
    const Memory from(device.context, bytes, "the copy's source"), to(device.context, bytes, "the copy's target");
    EventTimer timer(device.context);
    return measure_copies(bytes, [&](std::uint64_t each, unsigned times) {
        timer.start(device.stream.get());
        for (unsigned time = 0; time < times; ++time)
            device.context.check(
                device.driver().copy_on_device(to.address(), from.address(), each, device.stream.get()),
                "copying memory to memory");
        timer.stop(device.stream.get());
        return timer.seconds();
    });
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
    Yardstick measured = measured_copies(device);
    measured.launch_s = launch_s(device, probe);
    return measured;
}

} // namespace tetrace::cuda
