#include "backends/vulkan/rt/shader_table.h"

#include <cstring>
#include <vector>

namespace tetrace::vulkan {

ShaderTable::ShaderTable(const Context& context, const vk::raii::Pipeline& pipeline)
{
    const std::size_t handle_bytes = context.found().ray_tracing.handle_bytes;
    const std::uint64_t alignment = context.found().ray_tracing.handle_alignment;
    const auto aligned = [&](std::uint64_t value) { return (value + alignment - 1) / alignment * alignment; };
    const std::uint64_t stride = aligned(handle_bytes);
    std::vector<std::byte> bytes(parts_.size() * stride + alignment); // addresses of buffers may be less aligned
    memory_ = Buffer(context, bytes.size(), BufferUse::table);
    const vk::DeviceAddress first = aligned(memory_.address(context));
    const auto handles = pipeline.getRayTracingShaderGroupHandlesKHR<std::byte>(
        0, static_cast<std::uint32_t>(parts_.size()), parts_.size() * handle_bytes);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        parts_[i].setDeviceAddress(first + i * stride).setStride(stride).setSize(stride);
        const std::size_t offset = parts_[i].deviceAddress - memory_.address(context);
        std::memcpy(bytes.data() + offset, handles.data() + i * handle_bytes, handle_bytes);
    }
    upload(context, memory_, bytes);
}

void ShaderTable::record_launch(const vk::raii::CommandBuffer& commands, std::uint32_t width, std::uint32_t height,
                                std::uint32_t depth) const
{
    commands.traceRaysKHR(parts_[0], parts_[1], parts_[2], {}, width, height, depth);
}

} // namespace tetrace::vulkan
