#pragma once

#include "backends/vulkan/api.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tetrace::vulkan {

/// Whether a device can build BVHs and let compute shaders trace rays through them, and its limits.
struct RayQueries {
    std::string reason = "the driver offers no Vulkan 1.1"; ///< why it cannot, and what is needed; empty if it can
    std::uint64_t most_triangles = 0;                       ///< of a bottom level
    std::uint32_t scratch_alignment = 1;                    ///< of the address of a build's scratch memory, in bytes
};

/// The extensions that a device needs for it beyond Vulkan 1.1: the two themselves, and those that they depend on.
inline constexpr std::array ray_query_extensions = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,   VK_KHR_RAY_QUERY_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME, VK_KHR_BUFFER_DEVICE_ADDRESS_EXTENSION_NAME,
    VK_EXT_DESCRIPTOR_INDEXING_EXTENSION_NAME,      VK_KHR_SPIRV_1_4_EXTENSION_NAME,
    VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME};

using RayQueryFeatures =
    vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                       vk::PhysicalDeviceRayQueryFeaturesKHR, vk::PhysicalDeviceBufferDeviceAddressFeatures>;

/// The features that a device is opened with.
[[nodiscard]] RayQueryFeatures ray_query_features();

/// The ray queries that a device of Vulkan 1.1 or later offers.
[[nodiscard]] RayQueries ray_queries_of(const vk::raii::PhysicalDevice& device);

/// Why a device with these extensions has no ray queries: names those that it lacks, and what to install. Empty if it
/// has all. is_emulated: the device is the processor.
[[nodiscard]] std::string why_no_ray_queries(const std::vector<std::string>& extensions, bool is_emulated);

} // namespace tetrace::vulkan
