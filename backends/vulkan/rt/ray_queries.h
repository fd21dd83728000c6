#pragma once

#include "backends/vulkan/api.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tetrace::vulkan {

/// Whether a device builds BVHs of its own and lets compute shaders trace rays through them, and within what limits.
struct RayQueries {
    std::string reason = "the driver offers no Vulkan 1.1"; ///< why it does not, and what would; empty where it does
    std::uint64_t most_triangles = 0;                       ///< of a bottom level
    std::uint32_t scratch_alignment = 1;                    ///< of the address of a build's scratch memory, in bytes
};

/// What a device must have for it, as far as Vulkan 1.1 lacks it: the two themselves, and what they are made of.
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

/// What a device of Vulkan 1.1 or later offers.
[[nodiscard]] RayQueries ray_queries_of(const vk::raii::PhysicalDevice& device);

/// Why a device with these extensions has no ray queries: names those that it lacks, and what brings them.
/// Empty where it has all. is_emulated: the device is the processor.
[[nodiscard]] std::string why_no_ray_queries(const std::vector<std::string>& extensions, bool is_emulated);

} // namespace tetrace::vulkan
