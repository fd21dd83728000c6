#include "backends/vulkan/rt/ray_queries.h"

#include <algorithm>

namespace tetrace::vulkan {

namespace {

std::vector<std::string> extensions_of(const vk::raii::PhysicalDevice& device)
{
    std::vector<std::string> names;
    for (const vk::ExtensionProperties& extension : device.enumerateDeviceExtensionProperties())
        names.emplace_back(extension.extensionName.data());
    return names;
}

bool has_features(const vk::raii::PhysicalDevice& device)
{
    const auto features =
        device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                            vk::PhysicalDeviceRayQueryFeaturesKHR, vk::PhysicalDeviceBufferDeviceAddressFeatures>();
    return features.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure == VK_TRUE &&
           features.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().rayQuery == VK_TRUE &&
           features.get<vk::PhysicalDeviceBufferDeviceAddressFeatures>().bufferDeviceAddress == VK_TRUE;
}

} // namespace

RayQueryFeatures ray_query_features()
{
    RayQueryFeatures features;
    features.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().setAccelerationStructure(VK_TRUE);
    features.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().setRayQuery(VK_TRUE);
    features.get<vk::PhysicalDeviceBufferDeviceAddressFeatures>().setBufferDeviceAddress(VK_TRUE);
    return features;
}

std::string why_no_ray_queries(const std::vector<std::string>& extensions, bool is_emulated)
{
    std::string missing;
    for (const std::string needed : ray_query_extensions)
        if (std::ranges::find(extensions, needed) == extensions.end())
            missing += (missing.empty() ? "" : ", ") + needed;
    if (missing.empty()) return {};
    return "the driver lacks " + missing + "; " +
           (is_emulated ? "lavapipe has them in Mesa 25: mesa-vulkan-drivers of Debian 13, or of Debian 12's backports"
                        : "GPUs that trace rays have them, with a driver of the last years");
}

RayQueries ray_queries_of(const vk::raii::PhysicalDevice& device)
{
    RayQueries found;
    const bool is_emulated = device.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
    found.reason = why_no_ray_queries(extensions_of(device), is_emulated);
    if (!found.reason.empty()) return found;
    if (!has_features(device)) found.reason = "the driver has VK_KHR_ray_query, but not its features; a newer one may";
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceAccelerationStructurePropertiesKHR>()
            .get<vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
    found.most_triangles = properties.maxPrimitiveCount;
    found.scratch_alignment = std::max(1u, properties.minAccelerationStructureScratchOffsetAlignment);
    return found;
}

} // namespace tetrace::vulkan
