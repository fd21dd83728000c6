#pragma once

#include "backends/vulkan/context.h"

#include <cstddef>
#include <span>

namespace tetrace::vulkan {

/// Where a buffer is, and its purpose.
enum class BufferUse {
    device,    ///< the device's own memory: kernels and transfers use it
    upload,    ///< the host writes, transfers read
    read_back, ///< transfers write, the host reads through its caches
    geometry,  ///< of the device, by address: what a BVH is built from; this and the next three need a RayTracer
    structure, ///< of the device: a BVH built by the driver
    scratch,   ///< of the device, by address: scratch memory for building one
    table      ///< of the device, by address: a pipeline's shader table
};

/// A buffer with memory of its own.
class Buffer {
public:
    Buffer() = default;
    /// bytes: 0 makes the smallest possible buffer. Throws vk::SystemError (Context::run() translates it), and
    /// Error{unsupported} with both numbers where an allocation may not be that large.
    Buffer(const Context& context, std::uint64_t bytes, BufferUse use);

    [[nodiscard]] vk::Buffer handle() const { return *handle_; }
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    /// The device's address; only for places that are used by address.
    [[nodiscard]] vk::DeviceAddress address(const Context& context) const
    {
        return context.device().getBufferAddressKHR(vk::BufferDeviceAddressInfo{}.setBuffer(*handle_));
    }
    /// The memory as the host sees it; empty if it does not.
    [[nodiscard]] std::span<std::byte> mapped() const
    {
        return mapped_ == nullptr ? std::span<std::byte>{} : std::span(mapped_, bytes_);
    }
    /// Whether the host reads it through its caches.
    [[nodiscard]] bool is_cached() const
    {
        return static_cast<bool>(properties_ & vk::MemoryPropertyFlagBits::eHostCached);
    }
    /// Makes what the host wrote visible to the device, or the other way round; does nothing where memory is coherent.
    void flush(const Context& context) const
    {
        if (!(properties_ & vk::MemoryPropertyFlagBits::eHostCoherent))
            context.device().flushMappedMemoryRanges(whole());
    }
    void invalidate(const Context& context) const
    {
        if (!(properties_ & vk::MemoryPropertyFlagBits::eHostCoherent))
            context.device().invalidateMappedMemoryRanges(whole());
    }

private:
    [[nodiscard]] vk::MappedMemoryRange whole() const
    {
        return vk::MappedMemoryRange{}.setMemory(*memory_).setSize(VK_WHOLE_SIZE);
    }

    std::uint64_t bytes_ = 0;
    vk::MemoryPropertyFlags properties_;
    vk::raii::DeviceMemory memory_{nullptr}; // outlives the buffer
    vk::raii::Buffer handle_{nullptr};
    std::byte* mapped_ = nullptr;
};

/// Copies bytes to the start of the buffer and waits: directly if the host sees its memory, else through staging.
void upload(const Context& context, const Buffer& to, std::span<const std::byte> bytes);

/// Copies the start of the buffer into bytes, through memory that the host caches, and waits. staging:
/// BufferUse::read_back and large enough, or empty if needs_staging() is false.
void read_back(const Context& context, const Buffer& from, const Buffer& staging, std::span<std::byte> bytes);

/// Whether the host cannot read the buffer directly through its caches.
[[nodiscard]] bool needs_staging(const Buffer& buffer);

} // namespace tetrace::vulkan
