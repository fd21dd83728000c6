#pragma once

#include "backends/vulkan/context.h"

#include <cstddef>
#include <span>

namespace tetrace::vulkan {

/// Where a buffer lies, and what for.
enum class Place {
    device,    ///< the device's own memory: kernels and transfers use it
    upload,    ///< the host writes, transfers read
    read_back, ///< transfers write, the host reads through its caches
    geometry,  ///< of the device, by address: what a BVH is built of; this and the next two need Uses::ray_queries
    structure, ///< of the device: a BVH of the driver's
    scratch    ///< of the device, by address: what building one needs meanwhile
};

/// A buffer with memory of its own.
class Buffer {
public:
    Buffer() = default;
    /// bytes: 0 makes the smallest there is. Throws vk::SystemError (Context::run() translates it), and
    /// Error{unsupported} with both numbers where no single allocation may be that large.
    Buffer(const Context& context, std::uint64_t bytes, Place place);

    [[nodiscard]] vk::Buffer handle() const { return *handle_; }
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    /// As the device sees it; of those places alone that are used by address.
    [[nodiscard]] vk::DeviceAddress address(const Context& context) const;
    /// The memory as the host sees it; empty where it does not.
    [[nodiscard]] std::span<std::byte> mapped() const;
    /// Whether the host reads it through its caches.
    [[nodiscard]] bool is_cached() const;
    /// What the host wrote becomes visible to the device, and the other way round; nothing where memory is coherent.
    void flush(const Context& context) const;
    void invalidate(const Context& context) const;

private:
    [[nodiscard]] vk::MappedMemoryRange whole() const;

    std::uint64_t bytes_ = 0;
    vk::MemoryPropertyFlags properties_;
    vk::raii::DeviceMemory memory_{nullptr}; // outlives the buffer
    vk::raii::Buffer handle_{nullptr};
    std::byte* mapped_ = nullptr;
};

/// Copies bytes to the buffer's begin: straight where the host sees its memory, else by way of staging, and waits.
void upload(const Context& context, const Buffer& to, std::span<const std::byte> bytes);

/// Copies the buffer's begin into bytes, through memory that the host caches, and waits. staging: Place::read_back and
/// large enough, or empty where needs_staging() is false.
void read_back(const Context& context, const Buffer& from, const Buffer& staging, std::span<std::byte> bytes);

/// Whether the host cannot read the buffer itself at the speed of its caches.
[[nodiscard]] bool needs_staging(const Buffer& buffer);

} // namespace tetrace::vulkan
