#include "backends/vulkan/rt/ray_tracing.h"

#include <algorithm>

namespace tetrace::vulkan {

namespace {

using Names = std::vector<std::string>;

constexpr const char* extension_of(RayTracer tracer)
{
    return tracer == RayTracer::queries ? VK_KHR_RAY_QUERY_EXTENSION_NAME : VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME;
}

constexpr RayTracer other_than(RayTracer tracer)
{
    return tracer == RayTracer::queries ? RayTracer::pipeline : RayTracer::queries;
}

Names extensions_of(const vk::raii::PhysicalDevice& device)
{
    Names names;
    for (const vk::ExtensionProperties& extension : device.enumerateDeviceExtensionProperties())
        names.emplace_back(extension.extensionName.data());
    return names;
}

bool has(const Names& names, const std::string& name)
{
    return std::ranges::find(names, name) != names.end();
}

/// In one line. A driver without any tracer lacks either: ray queries, the usual one, are not all that would do.
std::string missing_extensions(RayTracer tracer, const Names& extensions)
{
    const std::string pipeline = extension_of(RayTracer::pipeline);
    std::string missing;
    for (const std::string needed : ray_extensions(tracer)) {
        if (has(extensions, needed)) continue;
        missing += (missing.empty() ? "" : ", ") + needed;
        if (needed == extension_of(RayTracer::queries) && !has(extensions, pipeline)) missing += " or " + pipeline;
    }
    return missing;
}

/// traces: the feature of the tracer.
template <class Features>
bool has_features(const vk::raii::PhysicalDevice& device, vk::Bool32 Features::*traces)
{
    const auto features =
        device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                            vk::PhysicalDeviceBufferDeviceAddressFeatures, Features>();
    return features.template get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure &&
           features.template get<vk::PhysicalDeviceBufferDeviceAddressFeatures>().bufferDeviceAddress &&
           features.template get<Features>().*traces;
}

std::string reason_against(RayTracer tracer, const Names& extensions, const vk::raii::PhysicalDevice& device)
{
    const bool is_emulated = device.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
    std::string reason = why_no_tracer(tracer, extensions, is_emulated);
    if (!reason.empty()) return reason;
    const bool has_them =
        tracer == RayTracer::queries
            ? has_features(device, &vk::PhysicalDeviceRayQueryFeaturesKHR::rayQuery)
            : has_features(device, &vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::rayTracingPipeline);
    if (has_them) return {};
    return std::string("the driver has ") + extension_of(tracer) + ", but not its features; a newer one may";
}

void find_structure_limits(const vk::raii::PhysicalDevice& device, RayTracing& found)
{
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceAccelerationStructurePropertiesKHR>()
            .get<vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
    found.max_triangles = properties.maxPrimitiveCount;
    found.scratch_alignment = std::max(1u, properties.minAccelerationStructureScratchOffsetAlignment);
}

void find_pipeline_limits(const vk::raii::PhysicalDevice& device, RayTracing& found)
{
    const auto chain =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceRayTracingPipelinePropertiesKHR>();
    const auto& compute = chain.get<vk::PhysicalDeviceProperties2>().properties.limits;
    const auto& rays = chain.get<vk::PhysicalDeviceRayTracingPipelinePropertiesKHR>();
    const std::uint64_t widest =
        std::uint64_t{compute.maxComputeWorkGroupCount[0]} * compute.maxComputeWorkGroupSize[0];
    found.max_rays = std::min<std::uint64_t>(rays.maxRayDispatchInvocationCount, widest);
    found.handle_bytes = rays.shaderGroupHandleSize;
    found.handle_alignment = std::max({1u, rays.shaderGroupBaseAlignment, rays.shaderGroupHandleAlignment});
}

} // namespace

std::vector<const char*> ray_extensions(RayTracer tracer)
{
    return {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,   extension_of(tracer),
            VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME, VK_KHR_BUFFER_DEVICE_ADDRESS_EXTENSION_NAME,
            VK_EXT_DESCRIPTOR_INDEXING_EXTENSION_NAME,      VK_KHR_SPIRV_1_4_EXTENSION_NAME,
            VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME};
}

RayFeatures ray_features(RayTracer tracer)
{
    RayFeatures features;
    features.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().setAccelerationStructure(VK_TRUE);
    features.get<vk::PhysicalDeviceBufferDeviceAddressFeatures>().setBufferDeviceAddress(VK_TRUE);
    features.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().setRayQuery(VK_TRUE);
    features.get<vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>().setRayTracingPipeline(VK_TRUE);
    if (tracer == RayTracer::queries)
        features.unlink<vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>();
    else
        features.unlink<vk::PhysicalDeviceRayQueryFeaturesKHR>();
    return features;
}

std::string why_no_tracer(RayTracer tracer, const std::vector<std::string>& extensions, bool is_emulated)
{
    const std::string missing = missing_extensions(tracer, extensions);
    if (missing.empty()) return {};
    const std::string reason = "the driver lacks " + missing + "; ";
    const RayTracer other = other_than(tracer);
    if (missing_extensions(other, extensions).empty())
        return reason + "it has " + extension_of(other) + ": take --schedule " +
               (other == RayTracer::queries ? "tiles" : "pipeline");
    return reason + (is_emulated
                         ? "lavapipe has them in Mesa 25: mesa-vulkan-drivers of Debian 13, or of Debian 12's backports"
                         : "GPUs that trace rays have them, with a driver of the last years");
}

RayTracing ray_tracing_of(const vk::raii::PhysicalDevice& device)
{
    const Names extensions = extensions_of(device);
    RayTracing found;
    found.no_queries = reason_against(RayTracer::queries, extensions, device);
    found.no_pipeline = reason_against(RayTracer::pipeline, extensions, device);
    if (found.no_queries.empty() || found.no_pipeline.empty()) find_structure_limits(device, found);
    if (found.no_pipeline.empty()) find_pipeline_limits(device, found);
    return found;
}

} // namespace tetrace::vulkan
