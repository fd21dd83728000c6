#include "backends/cuda/device.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/device/device_facts.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <regex>

namespace tetrace::cuda {

namespace {

constexpr double event_period_s = 0.5e-6; // of cuEventElapsedTime, as NVIDIA states it
constexpr double host_period_s = 1e-9;    // an emulation's events use the host's clock

std::string uuid_of(const Driver& driver, Ordinal ordinal)
{
    std::array<unsigned char, 16> bytes{};
    if (driver.device_uuid(bytes.data(), ordinal) != success) return {};
    return hexadecimal(bytes);
}

std::string pci_of(const Driver& driver, Ordinal ordinal)
{
    std::array<char, 32> id{};
    if (driver.device_pci(id.data(), id.size() - 1, ordinal) != success) return {};
    std::string text = id.data();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    constexpr std::size_t usual = std::string_view("0000:41:00.0").size();
    return text.size() > usual ? text.substr(text.size() - usual) : text; // some drivers give the domain 8 digits
}

/// "580.65.06", from the driver's kernel module; empty if it does not say.
std::string kernel_module_version()
{
    std::ifstream file("/proc/driver/nvidia/version");
    std::string line;
    std::getline(file, line);
    std::smatch match;
    return std::regex_search(line, match, std::regex(R"( (\d+\.\d+(\.\d+)?) )")) ? match[1].str() : "";
}

void describe_driver(Device& device, const Driver& driver)
{
    int version = 0;
    driver.driver_version(&version);
    device.driver = "CUDA " + version_text(version);
    if (driver.is_emulation()) {
        device.kind = DeviceKind::emulated;
        device.driver += ", emulated on the host";
        device.implementation = "cuda-host";
        device.timer_period_s = host_period_s;
        return;
    }
    const std::string module = kernel_module_version();
    device.kind = DeviceKind::gpu;
    if (!module.empty()) device.driver += ", NVIDIA driver " + module;
    device.implementation =
        module.empty() ? "nvidia-cuda-" + version_text(version) : implementation_name("nvidia-cuda", module);
    device.timer_period_s = event_period_s;
}

Device describe(const Driver& driver, Ordinal ordinal)
{
    Device device;
    std::array<char, 256> name{};
    driver.device_name(name.data(), name.size() - 1, ordinal);
    device.name = name.data();
    describe_driver(device, driver);
    device.uuid = uuid_of(driver, ordinal);
    device.pci = pci_of(driver, ordinal);
    device.id = id_of(device);
    std::size_t bytes = 0;
    driver.device_memory(&bytes, ordinal);
    device.memory_bytes = bytes;
    device.max_group_items = static_cast<unsigned>(attribute_of(driver, ordinal, attribute_block_threads));
    device.group_width = static_cast<unsigned>(attribute_of(driver, ordinal, attribute_warp_size));
    device.threads = static_cast<unsigned>(attribute_of(driver, ordinal, attribute_multiprocessors));
    device.cache_bytes = static_cast<std::uint64_t>(attribute_of(driver, ordinal, attribute_l2_bytes));
    return device;
}

} // namespace

Ordinal ordinal_of(const Driver& driver, std::size_t index)
{
    Ordinal ordinal = 0;
    if (const Result result = driver.device_get(&ordinal, static_cast<int>(index)); result != success)
        throw Error(ErrorKind::driver,
                    "CUDA: asking for device " + std::to_string(index) + ": " + text_of(driver, result));
    return ordinal;
}

int attribute_of(const Driver& driver, Ordinal device, int attribute)
{
    int value = 0;
    return driver.device_attribute(&value, attribute, device) == success ? value : 0;
}

int capability_of(const Driver& driver, Ordinal device)
{
    return 10 * attribute_of(driver, device, attribute_capability_major) +
           attribute_of(driver, device, attribute_capability_minor);
}

std::vector<Device> list_devices(const LoadedDriver& loaded, const Programs& programs)
{
    if (!loaded.usable()) return {unusable_device("none", loaded.reason)};
    const Driver& driver = loaded.driver;
    int count = 0;
    if (const Result result = driver.device_count(&count); result != success)
        return {unusable_device("none", "counting the NVIDIA driver's devices: " + text_of(driver, result))};
    if (count == 0) return {unusable_device("none", "the NVIDIA driver finds no device")};
    std::vector<Device> devices;
    for (int i = 0; i < count; ++i) {
        Device& device =
            devices.emplace_back(printable(describe(driver, ordinal_of(driver, static_cast<std::size_t>(i)))));
        device.library = printable_line(loaded.library);
        device.reports_code = !driver.is_emulation();
        device.usable = !programs.code.empty() || programs.has_nvrtc();
        if (!device.usable)
            device.reason = "this program was built without compiled CUDA kernels (nvcc makes them for the GPUs of the "
                            "building machine, or with -DTETRACE_CUDA_CODE=all), so NVRTC must compile them: " +
                            (programs.nvrtc != nullptr ? programs.nvrtc().reason() : "NVRTC is not used");
    }
    return devices;
}

OpenDevice::OpenDevice(const Driver& driver, Ordinal ordinal)
    : context(driver, ordinal), stream(make_stream(context)), capability(capability_of(driver, ordinal))
{
}

void OpenDevice::synchronize()
{
    context.check(driver().stream_synchronize(stream.get()), "waiting for the device");
}

void OpenDevice::launch(FunctionHandle function, unsigned blocks, unsigned block_threads,
                        std::span<void* const> parameters, unsigned shared_bytes, StreamHandle other)
{
    std::vector<void*> pointers(parameters.begin(), parameters.end());
    context.check(
        driver().launch(function, blocks, 1, 1, block_threads, 1, 1, shared_bytes, other, pointers.data(), nullptr),
        "launching a kernel");
}

} // namespace tetrace::cuda
