#include "backends/vulkan/driver_library.h"

#include "core/device/device_facts.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace tetrace::vulkan {

namespace {

std::vector<std::string> loaded_libraries()
{
    std::vector<std::string> names;
    const auto add = [](dl_phdr_info* info, std::size_t, void* list) {
        if (info->dlpi_name != nullptr && *info->dlpi_name != 0)
            static_cast<std::vector<std::string>*>(list)->emplace_back(info->dlpi_name);
        return 0;
    };
    ::dl_iterate_phdr(add, &names);
    return names;
}

template <class Function>
Function function_of(PFN_vkGetInstanceProcAddr driver, VkInstance instance, const char* name)
{
    return reinterpret_cast<Function>(driver(instance, name));
}

std::vector<VkPhysicalDeviceProperties> listed_by(PFN_vkGetInstanceProcAddr driver)
{
    const auto create = function_of<PFN_vkCreateInstance>(driver, nullptr, "vkCreateInstance");
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_1;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    VkInstance instance = nullptr;
    if (create == nullptr || create(&info, nullptr, &instance) != VK_SUCCESS) return {};
    const auto list = function_of<PFN_vkEnumeratePhysicalDevices>(driver, instance, "vkEnumeratePhysicalDevices");
    const auto describe =
        function_of<PFN_vkGetPhysicalDeviceProperties>(driver, instance, "vkGetPhysicalDeviceProperties");
    std::uint32_t count = 0;
    if (list(instance, &count, nullptr) != VK_SUCCESS) count = 0;
    std::vector<VkPhysicalDevice> devices(count);
    if (count > 0 && list(instance, &count, devices.data()) < 0) count = 0;
    std::vector<VkPhysicalDeviceProperties> found(count);
    for (std::uint32_t i = 0; i < count; ++i)
        describe(devices[i], &found[i]);
    function_of<PFN_vkDestroyInstance>(driver, instance, "vkDestroyInstance")(instance, nullptr);
    return found;
}

} // namespace

std::vector<DriverDevice> driver_devices()
{
    std::vector<DriverDevice> found;
    std::set<void*> asked; // dlsym() looks into the libraries that a library needs, too
    for (const std::string& name : loaded_libraries()) {
        void* const library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_NOLOAD);
        if (library == nullptr) continue;
        void* const entry = ::dlsym(library, "vk_icdGetInstanceProcAddr");
        if (entry != nullptr && asked.insert(entry).second)
            for (const auto& properties : listed_by(reinterpret_cast<PFN_vkGetInstanceProcAddr>(entry)))
                found.push_back({properties, library_holding(entry)});
        ::dlclose(library);
    }
    return found;
}

std::string library_of(const std::vector<DriverDevice>& devices, const VkPhysicalDeviceProperties& properties)
{
    const auto is_it = [&](const DriverDevice& device) {
        const VkPhysicalDeviceProperties& other = device.properties;
        return std::strncmp(other.deviceName, properties.deviceName, sizeof(other.deviceName)) == 0 &&
               other.driverVersion == properties.driverVersion && other.deviceID == properties.deviceID &&
               std::memcmp(other.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
    };
    const auto found = std::ranges::find_if(devices, is_it);
    return found == devices.end() ? std::string() : found->library;
}

} // namespace tetrace::vulkan
