#pragma once

#include "bench/rows/gpu_state.h"
#include "core/device/backend.h"

#include <functional>
#include <memory>

namespace tetrace {

/// Reads the clocks, the power and the throttling of one GPU.
class GpuMonitor {
public:
    virtual ~GpuMonitor() = default;
    /// The current readings. Throws nothing: what cannot be read is left out.
    [[nodiscard]] virtual GpuState read() = 0;
};

/// The monitor of a device; null if nothing reports about it.
using FindMonitor = std::function<std::unique_ptr<GpuMonitor>(const Device&)>;

/// NVIDIA's library (NVML) where it can be loaded and knows the device, else the files of the amdgpu driver; null for
/// devices on the host.
[[nodiscard]] std::unique_ptr<GpuMonitor> find_gpu_monitor(const Device& device);

/// By NVML. library: its file, for dlopen. Null if it cannot be loaded, cannot start, or lacks the device.
[[nodiscard]] std::unique_ptr<GpuMonitor> nvml_monitor(const Device& device, const char* library);

/// By the files of the amdgpu driver below `sysfs`/bus/pci/devices. Null if the device lacks these files.
[[nodiscard]] std::unique_ptr<GpuMonitor> amdgpu_monitor(const Device& device, const std::filesystem::path& sysfs);

} // namespace tetrace
