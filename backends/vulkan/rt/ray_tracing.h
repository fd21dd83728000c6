#pragma once

#include "backends/vulkan/api.h"
#include "core/pack/kernel_id.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tetrace::vulkan {

/// How shaders trace rays through a BVH that the driver has built: a compute shader asks ray queries, or a pipeline of
/// ray tracing runs shaders of its own for rays, hits and misses.
enum class RayTracer { queries, pipeline };

/// That of a kernel of layout rt.
[[nodiscard]] constexpr RayTracer tracer_of(const KernelId& kernel)
{
    return kernel.schedule == Schedule::pipeline ? RayTracer::pipeline : RayTracer::queries;
}

/// Whether a device can build BVHs and trace rays through them, and its limits.
struct RayTracing {
    std::string no_queries = "the driver offers no Vulkan 1.1"; ///< why it cannot, and what is needed; empty if it can
    std::string no_pipeline = no_queries;
    std::uint64_t max_triangles = 0;     ///< of a bottom level
    std::uint32_t scratch_alignment = 1; ///< of the address of a build's scratch memory, in bytes
    std::uint64_t max_rays = 0;          ///< of a launch of a pipeline
    std::uint32_t handle_bytes = 0;      ///< of a shader in a pipeline's shader table
    std::uint32_t handle_alignment = 1;  ///< of the address of each part of that table, in bytes

    [[nodiscard]] const std::string& why_not(RayTracer tracer) const
    {
        return tracer == RayTracer::queries ? no_queries : no_pipeline;
    }
};

/// The extensions that a device needs in addition to Vulkan 1.1: the tracer's, that of BVHs, and those that they depend
/// on.
[[nodiscard]] std::vector<const char*> ray_extensions(RayTracer tracer);

using RayFeatures =
    vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                       vk::PhysicalDeviceBufferDeviceAddressFeatures, vk::PhysicalDeviceRayQueryFeaturesKHR,
                       vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>;

/// The features that a device is opened with.
[[nodiscard]] RayFeatures ray_features(RayTracer tracer);

/// What a device of Vulkan 1.1 or later offers.
[[nodiscard]] RayTracing ray_tracing_of(const vk::raii::PhysicalDevice& device);

/// Why a device with these extensions cannot trace so: names those that it lacks, and what to do or install. Empty if
/// it has all. is_emulated: the device is the processor.
[[nodiscard]] std::string why_no_tracer(RayTracer tracer, const std::vector<std::string>& extensions, bool is_emulated);

} // namespace tetrace::vulkan
