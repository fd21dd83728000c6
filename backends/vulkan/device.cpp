#include "backends/vulkan/device.h"

#include "backends/vulkan/driver_library.h"
#include "backends/vulkan/instance.h"
#include "core/base/error.h"
#include "core/device/device_facts.h"
#include "core/device/launch.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace tetrace::vulkan {

namespace {

constexpr std::uint32_t tile_items = TILE_WIDTH * 8;

/// A device without a handle, which holds the reason why there is none.
FoundDevice no_device(const std::string& reason)
{
    FoundDevice none;
    none.facts = unusable_device("none", reason);
    return none;
}

/// A driver's text; not every driver ends it where it should.
template <std::size_t Size>
std::string text_of(const vk::ArrayWrapper1D<char, Size>& text)
{
    return {text.data(), ::strnlen(text.data(), Size)};
}

bool has_extension(const std::vector<vk::ExtensionProperties>& extensions, std::string_view name)
{
    return std::ranges::any_of(
        extensions, [&](const vk::ExtensionProperties& extension) { return text_of(extension.extensionName) == name; });
}

std::string version_text(std::uint32_t version)
{
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

std::string address_of(const vk::PhysicalDevicePCIBusInfoPropertiesEXT& pci)
{
    return pci_address(pci.pciDomain, pci.pciBus, pci.pciDevice, pci.pciFunction);
}

std::uint64_t device_memory(const vk::raii::PhysicalDevice& device)
{
    const vk::PhysicalDeviceMemoryProperties memory = device.getMemoryProperties();
    std::uint64_t largest = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
            largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[i].size);
    return largest;
}

void find_queue(const vk::raii::PhysicalDevice& device, Limits& limits)
{
    const auto families = device.getQueueFamilyProperties();
    for (std::uint32_t i = 0; i < families.size() && !limits.queue_family; ++i)
        if ((families[i].queueFlags & vk::QueueFlagBits::eCompute) && families[i].timestampValidBits > 0) {
            limits.queue_family = i;
            limits.timestamp_bits = families[i].timestampValidBits;
        }
}

/// As many as there are CPUs, or fewer by its own variable.
unsigned lavapipe_threads()
{
    const unsigned all = std::max(1u, std::thread::hardware_concurrency());
    const char* const text = std::getenv("LP_NUM_THREADS");
    unsigned number = 0;
    if (text != nullptr) std::from_chars(text, text + std::strlen(text), number);
    return number > 0 ? std::min(number, all) : all;
}

Limits limits_of(const vk::raii::PhysicalDevice& device)
{
    // Devices of 1.0 do not know the later structures.
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    Limits limits;
    limits.api_version = properties.apiVersion;
    limits.push_constant_bytes = properties.limits.maxPushConstantsSize;
    limits.storage_buffers = std::min(properties.limits.maxPerStageDescriptorStorageBuffers,
                                      properties.limits.maxDescriptorSetStorageBuffers);
    limits.texels = properties.limits.maxTexelBufferElements;
    limits.group_items = properties.limits.maxComputeWorkGroupInvocations;
    limits.group_height = properties.limits.maxComputeWorkGroupSize[1];
    limits.groups = properties.limits.maxComputeWorkGroupCount[0];
    find_queue(device, limits);
    return limits;
}

/// The properties of devices of Vulkan 1.1.
void describe(const vk::raii::PhysicalDevice& device, FoundDevice& found)
{
    const auto extensions = device.enumerateDeviceExtensionProperties();
    const auto chain =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties,
                              vk::PhysicalDeviceSubgroupProperties, vk::PhysicalDeviceMaintenance3Properties>();
    found.facts.uuid = hexadecimal(chain.get<vk::PhysicalDeviceIDProperties>().deviceUUID);
    const auto& subgroups = chain.get<vk::PhysicalDeviceSubgroupProperties>();
    found.facts.group_width = subgroups.subgroupSize;
    found.has_ballots = (subgroups.supportedStages & vk::ShaderStageFlagBits::eCompute) &&
                        (subgroups.supportedOperations & vk::SubgroupFeatureFlagBits::eBallot);
    found.limits.allocation_bytes = chain.get<vk::PhysicalDeviceMaintenance3Properties>().maxMemoryAllocationSize;
    found.facts.max_buffer_bytes = std::min(found.facts.max_buffer_bytes, found.limits.allocation_bytes);
    found.tells_cache_hits = has_extension(extensions, VK_EXT_PIPELINE_CREATION_FEEDBACK_EXTENSION_NAME);
    found.facts.reports_code = has_extension(extensions, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    if (has_extension(extensions, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME)) {
        const auto driver = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>()
                                .get<vk::PhysicalDeviceDriverProperties>();
        const std::string name = text_of(driver.driverName);
        std::string info = text_of(driver.driverInfo);
        if (info.empty()) info = version_text(device.getProperties().driverVersion); // SwiftShader
        found.facts.driver = name + " " + info;
        found.facts.implementation = implementation_of(name, info);
        found.facts.max_steps = max_steps_of(found.facts.implementation);
    }
    if (has_extension(extensions, VK_EXT_PCI_BUS_INFO_EXTENSION_NAME))
        found.facts.pci =
            address_of(device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDevicePCIBusInfoPropertiesEXT>()
                           .get<vk::PhysicalDevicePCIBusInfoPropertiesEXT>());
    if (has_extension(extensions, VK_NV_SHADER_SM_BUILTINS_EXTENSION_NAME))
        found.facts.threads =
            device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceShaderSMBuiltinsPropertiesNV>()
                .get<vk::PhysicalDeviceShaderSMBuiltinsPropertiesNV>()
                .shaderSMCount;
}

FoundDevice found_device(const vk::raii::PhysicalDevice& device)
{
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    FoundDevice found;
    found.handle = *device;
    found.limits = limits_of(device);
    Device& facts = found.facts;
    facts.name = text_of(properties.deviceName);
    const bool is_emulated = properties.deviceType == vk::PhysicalDeviceType::eCpu;
    facts.kind = is_emulated ? DeviceKind::emulated : DeviceKind::gpu;
    if (is_emulated) facts.threads = lavapipe_threads();
    // lavapipe 22.3 reads a storage buffer lane after lane, through memory: 3.5 times slower on this walk, and 7 times
    // where quads are read (results/texels.md).
    found.reads_texels = is_emulated;
    if (is_emulated) found.shares = facts.threads;
    // lavapipe's minimum is three instructions, two of them for NaNs; with selects bvh2 is 7 % faster, cwbvh 3 %.
    found.selects_minima = is_emulated;
    found.stack_top = is_emulated ? 0 : STACK_TOP_OF_GPUS; // a processor's shared memory is memory as any other
    facts.driver = "Vulkan driver " + version_text(properties.driverVersion);
    facts.implementation = "vulkan-" + std::to_string(properties.vendorID);
    facts.memory_bytes = device_memory(device);
    facts.max_buffer_bytes = properties.limits.maxStorageBufferRange;
    facts.max_group_items = properties.limits.maxComputeWorkGroupInvocations;
    facts.timer_period_s = 1e-9 * static_cast<double>(properties.limits.timestampPeriod);
    if (properties.apiVersion >= VK_API_VERSION_1_1) {
        describe(device, found);
        found.ray_tracing = ray_tracing_of(device);
    }
    facts.id = id_of(facts);
    facts.reason = why_not_usable(found.limits);
    facts.usable = facts.reason.empty();
    if (facts.usable && is_null_hardware(facts.implementation, facts.name)) {
        facts.usable = false;
        facts.compile_only = true;
        facts.reason = "compile only: hardware that is not here, which the driver offers because RADV_FORCE_FAMILY is "
                       "set; it compiles for it and runs nothing ('tetrace inspect' asks it)";
    }
    found.build_key = facts.name + ";" + facts.driver + ";" + std::to_string(properties.driverVersion) + ";" +
                      hexadecimal(properties.pipelineCacheUUID);
    return found;
}

/// Whether the same driver, installed twice, has listed it already. Devices without UUID are all listed.
bool is_listed(const std::vector<FoundDevice>& found, const FoundDevice& device)
{
    return !device.facts.uuid.empty() && std::ranges::any_of(found, [&](const FoundDevice& other) {
        return is_same_device(other.facts, device.facts);
    });
}

} // namespace

std::string implementation_of(std::string_view driver_name, std::string_view driver_info)
{
    if (driver_name == "llvmpipe") return implementation_name("lavapipe", driver_info);
    if (driver_name == "SwiftShader driver") return implementation_name("swiftshader", driver_info);
    return implementation_name(driver_name == "NVIDIA" ? "nvidia-vulkan" : driver_name, driver_info);
}

std::uint32_t max_steps_of(std::string_view implementation)
{
    constexpr std::string_view lavapipe = "lavapipe";
    constexpr unsigned first_without_limit = 25;
    if (!implementation.starts_with(lavapipe)) return 0;
    unsigned version = 0; // stays 0 if the driver states none
    if (implementation.size() > lavapipe.size() + 1)
        std::from_chars(implementation.data() + lavapipe.size() + 1, implementation.data() + implementation.size(),
                        version);
    return version >= first_without_limit ? 0 : 28'000;
}

bool is_null_hardware(std::string_view implementation, std::string_view device_name)
{
    // Mesa 22.3 calls it "Null hardware (RADV GFX1100)". Other versions may not: if the variable is set, radv lists
    // nothing else.
    const char* const family = std::getenv("RADV_FORCE_FAMILY");
    return implementation.starts_with("radv") &&
           (device_name.starts_with("Null hardware") || (family != nullptr && *family != '\0'));
}

std::string why_not_usable(const Limits& limits)
{
    const auto too_small = [](const char* what, std::uint64_t has, std::uint64_t needed) {
        return std::string(what) + ": " + std::to_string(has) + ", " + std::to_string(needed) + " are needed";
    };
    if (limits.api_version < VK_API_VERSION_1_1)
        return "the driver offers Vulkan " + version_text(limits.api_version) + ", 1.1 is needed; update the driver";
    if (!limits.queue_family) return "no queue of the device both computes and has timestamps";
    if (limits.push_constant_bytes < sizeof(LaunchParams))
        return too_small("bytes of push constants", limits.push_constant_bytes, sizeof(LaunchParams));
    if (limits.storage_buffers < min_storage_buffers)
        return too_small("storage buffers of a shader", limits.storage_buffers, min_storage_buffers);
    if (limits.group_items < tile_items) return too_small("items of a work group", limits.group_items, tile_items);
    if (limits.group_height < 8) return too_small("height of a work group", limits.group_height, 8);
    return {};
}

std::vector<FoundDevice> find_devices()
{
    try {
        std::vector<FoundDevice> found;
        const auto listed = instance().handle().enumeratePhysicalDevices();
        const std::vector<DriverDevice> drivers = driver_devices();
        for (const vk::raii::PhysicalDevice& device : listed) {
            FoundDevice next = found_device(device);
            next.facts.library = library_of(drivers, device.getProperties());
            if (!is_listed(found, next)) found.push_back(std::move(next));
        }
        if (!found.empty()) return found;
        return {no_device("no Vulkan driver found a device; install the GPU's driver, or mesa-vulkan-drivers")};
    } catch (const Error& error) {
        return {no_device(error.what())};
    } catch (const vk::SystemError& failure) {
        return {no_device(std::string("listing Vulkan's devices: ") + failure.what() +
                          "; install the GPU's driver, or mesa-vulkan-drivers")};
    }
}

} // namespace tetrace::vulkan
