#include "bench/measuring/gpu_monitor.h"

#include "bench/rows/physical_device.h"

namespace tetrace {

std::unique_ptr<GpuMonitor> find_gpu_monitor(const Device& device)
{
    if (runs_on_host(device)) return nullptr;
    auto monitor = nvml_monitor(device, "libnvidia-ml.so.1");
    return monitor != nullptr ? std::move(monitor) : amdgpu_monitor(device, "/sys");
}

} // namespace tetrace
