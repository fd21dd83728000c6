#pragma once

#include "backends/vulkan/device.h"
#include "backends/vulkan/errors.h"

#include <cstdint>
#include <string>

namespace tetrace::vulkan {

/// What a context is opened for: what devices offer beyond compute is enabled for those sessions alone that need it.
enum class Uses { compute, ray_queries };

/// A logical device with one queue: what belongs to one session, so that a device that is lost is lost to it alone.
class Context {
public:
    /// Throws Error where the driver fails. uses: ray_queries where found.ray_queries has no reason against it.
    explicit Context(const FoundDevice& found, Uses uses = Uses::compute);

    [[nodiscard]] const FoundDevice& found() const { return found_; }
    [[nodiscard]] const Device& facts() const { return found_.facts; }
    [[nodiscard]] const vk::raii::Device& device() const { return device_; }
    [[nodiscard]] const vk::raii::Queue& queue() const { return queue_; }

    [[nodiscard]] vk::PhysicalDeviceMemoryProperties memory() const;

    /// A command buffer that can be recorded again and again.
    [[nodiscard]] vk::raii::CommandBuffer make_commands() const;
    void submit(const vk::raii::CommandBuffer& commands) const;
    /// Waits for everything submitted.
    void finish() const;
    /// A pool for the two times of a piece of work.
    [[nodiscard]] vk::raii::QueryPool make_timestamps() const;
    /// Seconds between record_begin_time() and record_end_time(), in commands that have finished.
    [[nodiscard]] double seconds_of(const vk::raii::QueryPool& times) const;

    /// Does some work; an error of the API becomes Error, see to_error(), and what the validation layers say becomes
    /// Error{internal}. bytes: that the work needs on the device.
    template <class Work>
    auto run(const std::string& doing, std::uint64_t bytes, const Work& work) const
    {
        try {
            check_validation(doing);
            return work();
        } catch (const vk::SystemError& failure) {
            throw to_error(failure, {doing, facts().name, bytes, facts().memory_bytes});
        }
    }

    /// Throws Error{internal} where the validation layers have said something since the last time.
    void check_validation(const std::string& doing) const;

private:
    FoundDevice found_;
    vk::raii::Device device_{nullptr};
    vk::raii::Queue queue_{nullptr};
    vk::raii::CommandPool pool_{nullptr};
    vk::raii::Fence fence_{nullptr};
};

/// Both times are those at which all that was recorded or submitted before has ended: the spans of work that overlaps
/// count once.
void record_begin_time(const vk::raii::CommandBuffer& commands, const vk::raii::QueryPool& times);
void record_end_time(const vk::raii::CommandBuffer& commands, const vk::raii::QueryPool& times);

/// Makes what the transfers and kernels before it wrote visible to transfers, kernels and the host behind it.
void record_barrier(const vk::raii::CommandBuffer& commands);

} // namespace tetrace::vulkan
