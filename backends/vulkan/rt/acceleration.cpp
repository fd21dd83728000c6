#include "backends/vulkan/rt/acceleration.h"

#include "core/base/stopwatch.h"

#include <algorithm>
#include <string>

namespace tetrace::vulkan {

namespace {

using LevelType = vk::AccelerationStructureTypeKHR;
using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

/// Makes earlier copies and builds visible to later builds and kernels.
void record_build_barrier(const Context& context, const vk::raii::CommandBuffer& commands)
{
    const auto barrier = vk::MemoryBarrier{}
                             .setSrcAccessMask(Access::eTransferWrite | Access::eAccelerationStructureWriteKHR)
                             .setDstAccessMask(Access::eShaderRead | Access::eAccelerationStructureReadKHR |
                                               Access::eAccelerationStructureWriteKHR);
    commands.pipelineBarrier(Stage::eTransfer | Stage::eAccelerationStructureBuildKHR,
                             Stage::eAccelerationStructureBuildKHR | context.shader_stage(), {}, barrier, {}, {});
}

void require_triangles_fit(const Context& context, const TriangleMesh& mesh)
{
    const std::uint64_t most = context.found().ray_tracing.max_triangles;
    if (mesh.triangles.size() <= most) return;
    throw Error(ErrorKind::unsupported, "the mesh has " + std::to_string(mesh.triangles.size()) +
                                            " triangles, a structure of '" + context.facts().name + "' " +
                                            std::to_string(most));
}

std::uint64_t bytes_of(const TriangleMesh& mesh)
{
    return std::as_bytes(std::span(mesh.vertices)).size() + std::as_bytes(std::span(mesh.triangles)).size();
}

vk::AccelerationStructureGeometryKHR opaque(vk::GeometryTypeKHR type, vk::AccelerationStructureGeometryDataKHR data)
{
    return vk::AccelerationStructureGeometryKHR{}
        .setGeometryType(type)
        .setFlags(vk::GeometryFlagBitsKHR::eOpaque)
        .setGeometry(data);
}

/// The driver is asked for fast tracing, not for a fast build.
vk::AccelerationStructureBuildGeometryInfoKHR build_info(LevelType type,
                                                         const vk::AccelerationStructureGeometryKHR& geometry)
{
    using Flag = vk::BuildAccelerationStructureFlagBitsKHR;
    vk::BuildAccelerationStructureFlagsKHR flags = Flag::ePreferFastTrace;
    if (type == LevelType::eBottomLevel) flags |= Flag::eAllowCompaction;
    return vk::AccelerationStructureBuildGeometryInfoKHR{}.setType(type).setFlags(flags).setGeometries(geometry);
}

} // namespace

Acceleration::Acceleration(const Context& context, const TriangleMesh& mesh) : context_(&context)
{
    require_triangles_fit(context, mesh);
    context.run("building the driver's BVH", bytes_of(mesh), [&] {
        bottom_ = compacted(build_bottom(mesh));
        top_ = build_top();
    });
    context.check_validation("the BVH's first use");
}

template <class Record>
void Acceleration::run_timed(const Record& record)
{
    const vk::raii::QueryPool times = context_->make_timestamps();
    const vk::raii::CommandBuffer commands = context_->make_commands();
    commands.begin({});
    record_build_barrier(*context_, commands);
    record_begin_time(commands, times);
    record(commands);
    record_end_time(commands, times);
    record_build_barrier(*context_, commands);
    commands.end();
    context_->submit(commands);
    context_->finish();
    build_s_ += context_->seconds_of(times);
}

Acceleration::Level Acceleration::make_level(LevelType type, std::uint64_t bytes) const
{
    Level level;
    level.memory = Buffer(*context_, bytes, BufferUse::structure);
    level.handle = context_->device().createAccelerationStructureKHR(
        vk::AccelerationStructureCreateInfoKHR{}.setBuffer(level.memory.handle()).setSize(bytes).setType(type));
    return level;
}

Acceleration::Level Acceleration::build(LevelType type, const vk::AccelerationStructureGeometryKHR& geometry,
                                        std::uint32_t count)
{
    auto info = build_info(type, geometry);
    const auto sizes = context_->device().getAccelerationStructureBuildSizesKHR(
        vk::AccelerationStructureBuildTypeKHR::eDevice, info, count);
    Level level = make_level(type, sizes.accelerationStructureSize);
    const std::uint64_t alignment = context_->found().ray_tracing.scratch_alignment;
    const Buffer scratch(*context_, sizes.buildScratchSize + alignment, BufferUse::scratch);
    const vk::DeviceAddress aligned = (scratch.address(*context_) + alignment - 1) / alignment * alignment;
    info.setDstAccelerationStructure(*level.handle)
        .setScratchData(vk::DeviceOrHostAddressKHR{}.setDeviceAddress(aligned));
    const auto range = vk::AccelerationStructureBuildRangeInfoKHR{}.setPrimitiveCount(count);
    run_timed([&](const vk::raii::CommandBuffer& commands) { commands.buildAccelerationStructuresKHR(info, &range); });
    return level;
}

Buffer Acceleration::uploaded(std::span<const std::byte> bytes)
{
    const Stopwatch watch;
    Buffer buffer(*context_, bytes.size(), BufferUse::geometry);
    upload(*context_, buffer, bytes);
    upload_s_ += watch.seconds();
    return buffer;
}

Acceleration::Level Acceleration::build_bottom(const TriangleMesh& mesh)
{
    static_assert(sizeof(Float3) == 12 && sizeof(mesh.triangles[0]) == 12, "the driver reads the mesh's own arrays");
    const Buffer vertices = uploaded(std::as_bytes(std::span(mesh.vertices)));
    const Buffer indices = uploaded(std::as_bytes(std::span(mesh.triangles)));
    const auto triangles =
        vk::AccelerationStructureGeometryTrianglesDataKHR{}
            .setVertexFormat(vk::Format::eR32G32B32Sfloat)
            .setVertexData(vk::DeviceOrHostAddressConstKHR{}.setDeviceAddress(vertices.address(*context_)))
            .setVertexStride(sizeof(Float3))
            .setMaxVertex(static_cast<std::uint32_t>(std::max<std::size_t>(1, mesh.vertices.size()) - 1))
            .setIndexType(vk::IndexType::eUint32)
            .setIndexData(vk::DeviceOrHostAddressConstKHR{}.setDeviceAddress(indices.address(*context_)));
    return build(LevelType::eBottomLevel, opaque(vk::GeometryTypeKHR::eTriangles, triangles),
                 static_cast<std::uint32_t>(mesh.triangles.size()));
}

std::uint64_t Acceleration::compacted_bytes(const Level& level) const
{
    const vk::raii::QueryPool sizes = context_->device().createQueryPool(
        vk::QueryPoolCreateInfo{}.setQueryType(vk::QueryType::eAccelerationStructureCompactedSizeKHR).setQueryCount(1));
    const vk::raii::CommandBuffer commands = context_->make_commands();
    commands.begin({});
    commands.resetQueryPool(*sizes, 0, 1);
    commands.writeAccelerationStructuresPropertiesKHR(*level.handle,
                                                      vk::QueryType::eAccelerationStructureCompactedSizeKHR, *sizes, 0);
    commands.end();
    context_->submit(commands);
    context_->finish();
    const auto [result, bytes] =
        sizes.getResult<std::uint64_t>(0, 1, sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
    return result == vk::Result::eSuccess ? bytes : level.memory.bytes();
}

Acceleration::Level Acceleration::compacted(const Level& level)
{
    Level small = make_level(LevelType::eBottomLevel, compacted_bytes(level));
    const auto copy = vk::CopyAccelerationStructureInfoKHR{}
                          .setSrc(*level.handle)
                          .setDst(*small.handle)
                          .setMode(vk::CopyAccelerationStructureModeKHR::eCompact);
    run_timed([&](const vk::raii::CommandBuffer& commands) { commands.copyAccelerationStructureKHR(copy); });
    return small;
}

Acceleration::Level Acceleration::build_top()
{
    VkAccelerationStructureInstanceKHR instance{}; // the bindings' type of its flags differs between their versions
    for (int axis = 0; axis < 3; ++axis)
        instance.transform.matrix[axis][axis] = 1;
    instance.mask = 0xFF;
    instance.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    instance.accelerationStructureReference = context_->device().getAccelerationStructureAddressKHR(
        vk::AccelerationStructureDeviceAddressInfoKHR{}.setAccelerationStructure(*bottom_.handle));
    const Buffer instances = uploaded(std::as_bytes(std::span(&instance, 1)));
    const auto data = vk::AccelerationStructureGeometryInstancesDataKHR{}.setData(
        vk::DeviceOrHostAddressConstKHR{}.setDeviceAddress(instances.address(*context_)));
    return build(LevelType::eTopLevel, opaque(vk::GeometryTypeKHR::eInstances, data), 1);
}

} // namespace tetrace::vulkan
