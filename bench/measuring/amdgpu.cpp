// What Linux's amdgpu driver shows of a GPU in files, below /sys/bus/pci/devices/<address>: hwmon, pp_dpm_* and
// gpu_metrics (the kernel's documentation, gpu/amdgpu/thermal.rst, and its header kgd_pp_interface.h).
#include "bench/measuring/gpu_monitor.h"
#include "core/base/files.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>

namespace tetrace {

namespace fs = std::filesystem;

namespace amdgpu {

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

std::unique_ptr<GpuMonitor> amdgpu_monitor(const Device& device, const fs::path& sysfs)
{
    if (device.pci.empty()) return nullptr;
    const fs::path folder = sysfs / "bus" / "pci" / "devices" / device.pci;
    const fs::path sensors = amdgpu::sensors_of(folder);
    return sensors.empty() ? nullptr : std::make_unique<amdgpu::AmdgpuMonitor>(folder, sensors);
}

} // namespace tetrace
