#include "bench/measuring/gpu_monitor.h"

#include "bench/rows/physical_device.h"
#include "bench/terminal/text.h"
#include "core/base/files.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <dlfcn.h>
#include <sstream>
#include <string_view>

namespace tetrace {

std::unique_ptr<GpuMonitor> find_gpu_monitor(const Device& device)
{
    if (runs_on_host(device)) return nullptr;
    auto monitor = nvml_monitor(device, "libnvidia-ml.so.1");
    return monitor != nullptr ? std::move(monitor) : amdgpu_monitor(device, "/sys");
}

// NVIDIA's management library, which comes with its driver. Its functions are declared here as its documentation states
// them (NVML API reference, "Device Queries"): nothing of it is needed to build.
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
            if ((bits & reason.bit) != 0) append_item(state.throttled, ", ", reason.text);
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

// What Linux's amdgpu driver shows of a GPU in files, below /sys/bus/pci/devices/<address>: hwmon, pp_dpm_* and
// gpu_metrics (the kernel's documentation, gpu/amdgpu/thermal.rst, and its header kgd_pp_interface.h).
namespace amdgpu {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file)
{
    return file_bytes(file).value_or(""); // a sensor of a GPU that sleeps may answer with an error
}

/// Its number, scaled; empty if there is none.
std::optional<double> number_in(const fs::path& file, double scale)
{
    const std::string text = text_of(file);
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return std::nullopt;
    return scale * static_cast<double>(value);
}

/// Of the lines of pp_dpm_sclk, such as "1: 2304Mhz *", the one that is marked.
std::optional<double> marked_mhz(const fs::path& file)
{
    std::istringstream lines(text_of(file));
    for (std::string line; std::getline(lines, line);) {
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos || line.find('*') == std::string::npos) continue;
        double mhz = 0;
        const auto [end, error] = std::from_chars(line.data() + colon + 2, line.data() + line.size(), mhz);
        if (error == std::errc()) return mhz;
    }
    return std::nullopt;
}

/// gpu_metrics of discrete GPUs: format 1, content 1 to 3, which agree up to the word that says what throttles.
bool is_throttled(const fs::path& file)
{
    constexpr std::size_t place_of_word = 68;
    const std::string bytes = text_of(file);
    if (bytes.size() < place_of_word + 4 || bytes[2] != 1 || bytes[3] < 1 || bytes[3] > 3) return false;
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + place_of_word, sizeof word);
    return word != 0 && word != 0xFFFFFFFFu; // the latter is what cannot be told
}

class AmdgpuMonitor : public GpuMonitor {
public:
    AmdgpuMonitor(fs::path folder, fs::path sensors) : folder_(std::move(folder)), sensors_(std::move(sensors)) {}

    [[nodiscard]] GpuState read() override
    {
        GpuState state;
        state.clock_mhz = number_in(sensors_ / "freq1_input", 1e-6);
        if (!state.clock_mhz) state.clock_mhz = marked_mhz(folder_ / "pp_dpm_sclk");
        state.memory_clock_mhz = marked_mhz(folder_ / "pp_dpm_mclk");
        for (const char* const name : {"power1_average", "power1_input"})
            if (!state.power_w) state.power_w = number_in(sensors_ / name, 1e-6);
        state.temperature_c = number_in(sensors_ / "temp1_input", 1e-3);
        if (is_throttled(folder_ / "gpu_metrics")) state.throttled = "power or heat";
        return state;
    }

private:
    fs::path folder_, sensors_;
};

/// The folder of sensors that the driver calls amdgpu; empty if there is none.
fs::path sensors_of(const fs::path& folder)
{
    std::error_code ignored; // no such folder: not this driver's device
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "hwmon", ignored))
        if (text_of(entry.path() / "name").starts_with("amdgpu")) return entry.path();
    return {};
}

} // namespace amdgpu

std::unique_ptr<GpuMonitor> amdgpu_monitor(const Device& device, const std::filesystem::path& sysfs)
{
    if (device.pci.empty()) return nullptr;
    const std::filesystem::path folder = sysfs / "bus" / "pci" / "devices" / device.pci;
    const std::filesystem::path sensors = amdgpu::sensors_of(folder);
    return sensors.empty() ? nullptr : std::make_unique<amdgpu::AmdgpuMonitor>(folder, sensors);
}

} // namespace tetrace
