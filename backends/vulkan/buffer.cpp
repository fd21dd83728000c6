#include "backends/vulkan/buffer.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>

namespace tetrace::vulkan {

namespace {

using Property = vk::MemoryPropertyFlagBits;
constexpr std::uint64_t staging_bytes = std::uint64_t{64} << 20;

vk::BufferUsageFlags usage_of(BufferUse use)
{
    using Usage = vk::BufferUsageFlagBits;
    switch (use) {
    case BufferUse::upload: return Usage::eTransferSrc;
    case BufferUse::read_back: return Usage::eTransferDst;
    case BufferUse::geometry:
        return Usage::eAccelerationStructureBuildInputReadOnlyKHR | Usage::eShaderDeviceAddress | Usage::eTransferDst;
    case BufferUse::structure: return Usage::eAccelerationStructureStorageKHR | Usage::eShaderDeviceAddress;
    case BufferUse::scratch: return Usage::eStorageBuffer | Usage::eShaderDeviceAddress;
    case BufferUse::table: return Usage::eShaderBindingTableKHR | Usage::eShaderDeviceAddress | Usage::eTransferDst;
    case BufferUse::device: break;
    }
    return Usage::eStorageBuffer | Usage::eUniformTexelBuffer | Usage::eIndirectBuffer | Usage::eTransferSrc |
           Usage::eTransferDst;
}

bool has_address(BufferUse use)
{
    return static_cast<bool>(usage_of(use) & vk::BufferUsageFlagBits::eShaderDeviceAddress);
}

/// Preferred properties, best first. Every device has the last of each list (Vulkan 1.1, section 11.2.1), except
/// host-cached memory.
std::initializer_list<vk::MemoryPropertyFlags> wishes_for(BufferUse use)
{
    static const std::initializer_list<vk::MemoryPropertyFlags> device = {Property::eDeviceLocal, {}};
    static const std::initializer_list<vk::MemoryPropertyFlags> upload = {
        Property::eHostVisible | Property::eHostCoherent, Property::eHostVisible};
    static const std::initializer_list<vk::MemoryPropertyFlags> read_back = {
        Property::eHostVisible | Property::eHostCached, Property::eHostVisible};
    return use == BufferUse::upload ? upload : use == BufferUse::read_back ? read_back : device;
}

/// Drivers order their types such that the first with the wanted properties has the fewest others.
std::uint32_t memory_type(const vk::PhysicalDeviceMemoryProperties& memory, std::uint32_t allowed, BufferUse use)
{
    for (const vk::MemoryPropertyFlags wish : wishes_for(use))
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
            if ((allowed >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & wish) == wish) return i;
    throw Error(ErrorKind::unsupported, "no memory type of the device fits a buffer");
}

} // namespace

Buffer::Buffer(const Context& context, std::uint64_t bytes, BufferUse use)
    : bytes_(std::max<std::uint64_t>(16, (bytes + 3) / 4 * 4))
{
    handle_ = context.device().createBuffer(vk::BufferCreateInfo{}.setSize(bytes_).setUsage(usage_of(use)));
    const vk::MemoryRequirements needs = handle_.getMemoryRequirements();
    if (needs.size > context.found().limits.allocation_bytes)
        throw Error(ErrorKind::unsupported, "a buffer of " + std::to_string(needs.size) + " bytes on '" +
                                                context.facts().name + "', whose largest allocation has " +
                                                std::to_string(context.found().limits.allocation_bytes));
    const auto memory = context.memory();
    const std::uint32_t type = memory_type(memory, needs.memoryTypeBits, use);
    properties_ = memory.memoryTypes[type].propertyFlags;
    const auto with_address = vk::MemoryAllocateFlagsInfo{}.setFlags(vk::MemoryAllocateFlagBits::eDeviceAddress);
    auto allocation = vk::MemoryAllocateInfo{}.setAllocationSize(needs.size).setMemoryTypeIndex(type);
    if (has_address(use)) allocation.setPNext(&with_address);
    memory_ = context.device().allocateMemory(allocation);
    handle_.bindMemory(*memory_, 0);
    const bool is_hosts = use == BufferUse::upload || use == BufferUse::read_back;
    const bool is_hidden = !is_hosts && context.found().always_stages;
    if ((properties_ & Property::eHostVisible) && !is_hidden)
        mapped_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE, {}));
}

namespace {

void copy_and_wait(const Context& context, const Buffer& from, const Buffer& to, const vk::BufferCopy& region)
{
    const vk::raii::CommandBuffer commands = context.make_commands();
    commands.begin({});
    record_barrier(context, commands);
    commands.copyBuffer(from.handle(), to.handle(), region);
    record_barrier(context, commands);
    commands.end();
    context.submit(commands);
    context.finish();
}

} // namespace

void upload(const Context& context, const Buffer& to, std::span<const std::byte> bytes)
{
    if (bytes.empty()) return;
    if (!to.mapped().empty()) {
        std::memcpy(to.mapped().data(), bytes.data(), bytes.size());
        to.flush(context);
        return;
    }
    const Buffer staging(context, std::min<std::uint64_t>(bytes.size(), staging_bytes), BufferUse::upload);
    for (std::size_t done = 0; done < bytes.size();) {
        const auto part = bytes.subspan(done, std::min<std::size_t>(staging.bytes(), bytes.size() - done));
        std::memcpy(staging.mapped().data(), part.data(), part.size());
        staging.flush(context);
        copy_and_wait(context, staging, to, vk::BufferCopy{}.setDstOffset(done).setSize(part.size()));
        done += part.size();
    }
}

bool needs_staging(const Buffer& buffer)
{
    return buffer.mapped().empty() || !buffer.is_cached();
}

void read_back(const Context& context, const Buffer& from, const Buffer& staging, std::span<std::byte> bytes)
{
    if (bytes.empty()) return;
    const Buffer& source = needs_staging(from) ? staging : from;
    if (needs_staging(from)) copy_and_wait(context, from, staging, vk::BufferCopy{}.setSize(bytes.size()));
    source.invalidate(context);
    std::memcpy(bytes.data(), source.mapped().data(), bytes.size());
}

} // namespace tetrace::vulkan
