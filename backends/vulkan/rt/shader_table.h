#pragma once

#include "backends/vulkan/buffer.h"

#include <array>

namespace tetrace::vulkan {

/// How a ray-tracing pipeline finds its shaders: the handles of its three groups, those of rays, misses and hits.
class ShaderTable {
public:
    /// pipeline: its groups are these three, in this order. context: of RayTracer::pipeline.
    ShaderTable(const Context& context, const vk::raii::Pipeline& pipeline);

    /// Records a launch of the bound pipeline, a ray for each of this many invocations.
    void record_launch(const vk::raii::CommandBuffer& commands, std::uint32_t width, std::uint32_t height,
                       std::uint32_t depth) const;

private:
    Buffer memory_;
    std::array<vk::StridedDeviceAddressRegionKHR, 3> parts_; ///< of it, each one handle
};

} // namespace tetrace::vulkan
