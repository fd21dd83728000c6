#include "backends/opencl/device.h"

#include "backends/opencl/errors.h"
#include "backends/opencl/loader.h"
#include "core/device/device_facts.h"
#include "core/device/launch.h"
#include "kernels/layouts/layout.h"

#include <CL/cl_ext.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace tetrace::opencl {

namespace {

constexpr std::size_t max_group = std::size_t{TILE_WIDTH} * 8;

template <class Value>
Value asked(const cl::Device& device, cl_device_info what)
{
    Value value{};
    if (const cl_int code = clGetDeviceInfo(device(), what, sizeof(value), &value, nullptr); code != CL_SUCCESS)
        throw cl::Error(code, "clGetDeviceInfo");
    return value;
}

bool has_extension(const cl::Device& device, const std::string& name)
{
    std::string extensions = " ";
    extensions.append(device.getInfo<CL_DEVICE_EXTENSIONS>()).append(" ");
    return extensions.find(" " + name + " ") != std::string::npos;
}

std::string trimmed(const std::string& text)
{
    const auto is_blank = [](unsigned char c) { return std::isspace(c) != 0 || c == 0; };
    const auto begin = std::ranges::find_if_not(text, is_blank);
    const auto end = std::find_if_not(text.rbegin(), text.rend(), is_blank).base();
    return begin < end ? std::string(begin, end) : std::string();
}

std::string uuid_of(const cl::Device& device)
{
    if (!has_extension(device, "cl_khr_device_uuid")) return {};
    return hexadecimal(asked<std::array<cl_uchar, CL_UUID_SIZE_KHR>>(device, CL_DEVICE_UUID_KHR));
}

std::string pci_of(const cl::Device& device)
{
    if (has_extension(device, "cl_khr_pci_bus_info")) {
        const auto pci = asked<cl_device_pci_bus_info_khr>(device, CL_DEVICE_PCI_BUS_INFO_KHR);
        return pci_address(pci.pci_domain, pci.pci_bus, pci.pci_device, pci.pci_function);
    }
    if (!has_extension(device, "cl_nv_device_attribute_query")) return {};
    constexpr cl_device_info bus_nv = 0x4008, slot_nv = 0x4009, domain_nv = 0x400A; // in no header of Khronos's
    const auto slot = asked<cl_uint>(device, slot_nv); // the device's number, then three bits of function
    cl_uint domain = 0;
    (void)clGetDeviceInfo(device(), domain_nv, sizeof(domain), &domain, nullptr); // older drivers: domain 0
    return pci_address(domain, asked<cl_uint>(device, bus_nv), slot >> 3, slot & 7);
}

/// A driver's entry for ICD loaders (cl_khr_icd) is a function of its own library.
std::string library_of(const cl::Platform& platform)
{
    return library_holding(clGetExtensionFunctionAddressForPlatform(platform(), "clIcdGetPlatformIDsKHR"));
}

unsigned group_width_of(const cl::Device& device)
{
    if (has_extension(device, "cl_nv_device_attribute_query")) return asked<cl_uint>(device, CL_DEVICE_WARP_SIZE_NV);
    if (has_extension(device, "cl_amd_device_attribute_query"))
        return asked<cl_uint>(device, CL_DEVICE_WAVEFRONT_WIDTH_AMD);
    return 0;
}

/// Oclgrind's device claims to be of every type.
DeviceKind kind_of(const cl::Device& device)
{
    return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0 ? DeviceKind::emulated : DeviceKind::gpu;
}

/// Whether it has OpenCL C 3.0, and there a fence between all its groups.
bool has_device_fences(const cl::Device& device)
{
    constexpr cl_device_info version_queried = 0x105E, fences_queried = 0x1064;
    constexpr cl_uint version_3 = 3u << 22;
    constexpr cl_bitfield wanted = 1u << 1 | 1u << 5; // acquire and release, scope of the device
    cl_uint version = 0;
    cl_bitfield fences = 0;
    (void)clGetDeviceInfo(device(), version_queried, sizeof(version), &version, nullptr); // older drivers: 0
    (void)clGetDeviceInfo(device(), fences_queried, sizeof(fences), &fences, nullptr);
    return version >= version_3 && (fences & wanted) == wanted;
}

/// Empty if the device has all that the kernels need; else the reason.
std::string reason_against(const cl::Device& device, std::size_t group_items)
{
    if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "its driver says that it is not available";
    if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "its driver lacks a compiler for OpenCL C";
    if (!device.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) return "it is big-endian, packed scenes are not";
    if (group_items < max_group)
        return "its work groups have " + std::to_string(group_items) + " items, a tile needs " +
               std::to_string(max_group);
    if (device.getInfo<CL_DEVICE_VERSION>().starts_with("OpenCL 1.0") ||
        device.getInfo<CL_DEVICE_VERSION>().starts_with("OpenCL 1.1"))
        return "it offers " + trimmed(device.getInfo<CL_DEVICE_VERSION>()) + ", the kernels need OpenCL 1.2";
    return {};
}

void describe(const cl::Platform& platform, FoundDevice& found)
{
    const cl::Device device(found.id, true);
    Device& facts = found.facts;
    facts.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    facts.kind = kind_of(device);
    const std::string platform_name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    const std::string platform_version = trimmed(platform.getInfo<CL_PLATFORM_VERSION>());
    const std::string driver_version = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    facts.driver = platform_name + " " + driver_version;
    facts.implementation = implementation_of(platform_name, driver_version, platform_version);
    found.keeps_programs = facts.implementation.starts_with("pocl-");
    found.mixes_up_widths = found.keeps_programs && facts.implementation < "pocl-6"; // "pocl-10" too: harmless
    facts.uuid = uuid_of(device);
    facts.pci = pci_of(device);
    facts.library = library_of(platform);
    facts.id = id_of(facts);
    facts.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    facts.cache_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
    facts.max_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    const auto sizes = device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>();
    const std::size_t group_items =
        std::min(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(), sizes.empty() ? 0 : sizes.front());
    facts.max_group_items = static_cast<unsigned>(group_items);
    facts.group_width = group_width_of(device);
    facts.timer_period_s = 1e-9 * static_cast<double>(device.getInfo<CL_DEVICE_PROFILING_TIMER_RESOLUTION>());
    facts.threads = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    facts.reports_code = true; // of each kernel OpenCL 1.2 has some figures
    facts.reason = reason_against(device, group_items);
    facts.usable = facts.reason.empty();
    // What a processor's driver calls local memory is memory as any other.
    found.stack_top = facts.kind == DeviceKind::gpu ? STACK_TOP_OF_GPUS : 0;
    found.divides_correctly = (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    found.has_ballots = has_extension(device, "cl_khr_subgroup_ballot");
    found.has_fences = has_device_fences(device);
    found.build_key = platform_name + "\n" + platform_version + "\n" + driver_version + "\n" + facts.name + "\n" +
                      device.getInfo<CL_DEVICE_VERSION>();
}

FoundDevice unusable(const std::string& name, const std::string& reason)
{
    FoundDevice found;
    found.facts = unusable_device(name, reason);
    return found;
}

FoundDevice described(const cl::Platform& platform, const cl::Device& handle)
{
    FoundDevice found;
    found.id = handle();
    try {
        describe(platform, found);
    } catch (const cl::Error& failure) {
        found.facts.usable = false;
        found.facts.reason =
            std::string("it cannot be described: ") + failure.what() + " gave " + error_name(failure.err());
    }
    return found;
}

std::string short_name(std::string_view platform_name)
{
    if (platform_name == "Portable Computing Language") return "pocl";
    if (platform_name.starts_with("NVIDIA")) return "nvidia-opencl";
    return platform_name.empty() ? "opencl" : std::string(platform_name);
}

std::vector<FoundDevice> devices_of(const cl::Platform& platform)
{
    std::vector<FoundDevice> devices;
    try {
        std::vector<cl::Device> handles;
        platform.getDevices(CL_DEVICE_TYPE_ALL, &handles); // having none is no error for these bindings
        for (const cl::Device& handle : handles)
            devices.push_back(described(platform, handle));
        if (!handles.empty()) return devices;
        const std::string name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        devices.push_back(
            unusable(name, short_name(name) == "pocl"
                               ? "PoCL lists no device, as it does if its cache folder cannot be written to; set "
                                 "XDG_CACHE_HOME or POCL_CACHE_DIR to one that can"
                               : "this platform has no device here: its hardware is missing or closed to us"));
    } catch (const cl::Error& failure) {
        devices.push_back(unusable("a platform", std::string("its devices cannot be listed: ") + failure.what() +
                                                     " gave " + error_name(failure.err())));
    }
    return devices;
}

/// Whether two platforms are one driver that is installed twice: the same devices in the same order. Devices of one
/// platform are never taken for each other: two of one model may have neither UUID nor PCI address.
bool is_same_list(const std::vector<FoundDevice>& a, const std::vector<FoundDevice>& b)
{
    return std::ranges::equal(a, b, [](const FoundDevice& one, const FoundDevice& other) {
        return one.build_key == other.build_key && is_same_device(one.facts, other.facts) &&
               one.facts.reason == other.facts.reason;
    });
}

} // namespace

std::string implementation_of(std::string_view platform_name, std::string_view driver_version,
                              std::string_view platform_version)
{
    std::string_view version = driver_version;
    const bool has_number = std::ranges::any_of(version, [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!has_number && platform_version.starts_with("OpenCL ")) { // "OpenCL <its version> <vendor's information>"
        const std::size_t space = platform_version.find(' ', 7);
        version = space == std::string_view::npos ? "" : platform_version.substr(space);
    }
    return implementation_name(short_name(platform_name), version);
}

std::vector<FoundDevice> find_devices()
{
    std::vector<cl::Platform> platforms;
    if (!why_no_loader().empty()) return {unusable("none", why_no_loader())};
    std::string why_none = "no platform";
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& failure) {
        why_none = error_name(failure.err());
    }
    std::vector<FoundDevice> devices;
    std::vector<std::vector<FoundDevice>> listed;
    for (const cl::Platform& platform : platforms) {
        auto found = devices_of(platform);
        if (std::ranges::any_of(listed, [&](const auto& other) { return is_same_list(other, found); })) continue;
        devices.insert(devices.end(), found.begin(), found.end());
        listed.push_back(std::move(found));
    }
    if (devices.empty())
        devices.push_back(unusable("none", "no OpenCL driver was found (" + why_none +
                                               "); install pocl-opencl-icd, which runs on the processor, or the "
                                               "OpenCL part of the GPU's driver (nvidia-opencl-icd, mesa-opencl-icd, "
                                               "intel-opencl-icd)"));
    return devices;
}

} // namespace tetrace::opencl
