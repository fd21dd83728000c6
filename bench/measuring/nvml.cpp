// NVIDIA's management library, which comes with its driver. Its functions are declared here as its documentation states
// them (NVML API reference, "Device Queries"): nothing of it is needed to build.
#include "bench/measuring/gpu_monitor.h"

#include <dlfcn.h>
#include <string_view>

namespace tetrace {

namespace nvml {

using Handle = struct nvmlDevice_st*;
constexpr int success = 0;
constexpr unsigned clock_of_multiprocessors = 1, clock_of_memory = 2, sensor_of_gpu = 0;

/// Why clocks are held down; what users set, and idling, is not throttling.
struct Reason {
    unsigned long long bit;
    const char* text;
};
constexpr Reason reasons[] = {
    {0x04, "power"}, {0x08, "hardware slowdown"}, {0x20, "heat"}, {0x40, "hardware heat"}, {0x80, "power brake"}};

/// Those functions that are asked; a library may lack some of them.
struct Library {
    int (*start)() = nullptr;
    int (*by_uuid)(const char*, Handle*) = nullptr;
    int (*by_pci)(const char*, Handle*) = nullptr;
    int (*clock)(Handle, unsigned, unsigned*) = nullptr;
    int (*power)(Handle, unsigned*) = nullptr;
    int (*temperature)(Handle, unsigned, unsigned*) = nullptr;
    int (*throttling)(Handle, unsigned long long*) = nullptr;
};

template <class Function>
void find(void* library, Function& function, const char* symbol)
{
    function = reinterpret_cast<Function>(dlsym(library, symbol));
}

/// Started; null functions where it cannot be loaded. It stays loaded, as drivers do.
Library load(const char* name)
{
    Library found;
    void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return found;
    find(library, found.start, "nvmlInit_v2");
    if (found.start == nullptr || found.start() != success) return found;
    find(library, found.by_uuid, "nvmlDeviceGetHandleByUUID");
    find(library, found.by_pci, "nvmlDeviceGetHandleByPciBusId_v2");
    find(library, found.clock, "nvmlDeviceGetClockInfo");
    find(library, found.power, "nvmlDeviceGetPowerUsage");
    find(library, found.temperature, "nvmlDeviceGetTemperature");
    find(library, found.throttling, "nvmlDeviceGetCurrentClocksThrottleReasons");
    if (found.throttling == nullptr)
        find(library, found.throttling, "nvmlDeviceGetCurrentClocksEventReasons"); // its newer name
    return found;
}

/// "GPU-8-4-4-4-12" of 32 digits.
std::string uuid_text(const std::string& digits)
{
    return "GPU-" + digits.substr(0, 8) + "-" + digits.substr(8, 4) + "-" + digits.substr(12, 4) + "-" +
           digits.substr(16, 4) + "-" + digits.substr(20);
}

Handle handle_of(const Library& library, const Device& device)
{
    Handle handle = nullptr;
    if (device.uuid.size() == 32 && library.by_uuid != nullptr &&
        library.by_uuid(uuid_text(device.uuid).c_str(), &handle) == success)
        return handle;
    if (!device.pci.empty() && library.by_pci != nullptr && library.by_pci(device.pci.c_str(), &handle) == success)
        return handle;
    return nullptr;
}

class NvmlMonitor : public GpuMonitor {
public:
    NvmlMonitor(const Library& library, Handle device) : library_(library), device_(device) {}

    [[nodiscard]] GpuState read() override
    {
        GpuState state;
        state.clock_mhz = clock(clock_of_multiprocessors);
        state.memory_clock_mhz = clock(clock_of_memory);
        unsigned value = 0;
        if (library_.power != nullptr && library_.power(device_, &value) == success) state.power_w = 1e-3 * value;
        if (library_.temperature != nullptr && library_.temperature(device_, sensor_of_gpu, &value) == success)
            state.temperature_c = value;
        unsigned long long bits = 0;
        if (library_.throttling == nullptr || library_.throttling(device_, &bits) != success) return state;
        for (const Reason& reason : reasons)
            if ((bits & reason.bit) != 0)
                state.throttled += (state.throttled.empty() ? "" : ", ") + std::string(reason.text);
        return state;
    }

private:
    [[nodiscard]] std::optional<double> clock(unsigned which) const
    {
        unsigned mhz = 0;
        if (library_.clock == nullptr || library_.clock(device_, which, &mhz) != success) return std::nullopt;
        return mhz;
    }

    Library library_;
    Handle device_;
};

} // namespace nvml

std::unique_ptr<GpuMonitor> nvml_monitor(const Device& device, const char* library)
{
    const nvml::Library loaded = nvml::load(library);
    const nvml::Handle handle = nvml::handle_of(loaded, device);
    return handle != nullptr ? std::make_unique<nvml::NvmlMonitor>(loaded, handle) : nullptr;
}

} // namespace tetrace
