#pragma once

#include "backends/vulkan/device.h"
#include "backends/vulkan/errors.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tetrace::vulkan {

/// What make() makes. If the driver refuses to make one more, the newest that is still in use: NVIDIA's driver makes 63
/// devices a process, and rows may be more.
template <class Handle, class Make>
[[nodiscard]] std::shared_ptr<Handle> made_or_shared(std::weak_ptr<Handle>& newest, const Make& make)
{
    try {
        const auto made = std::make_shared<Handle>(make());
        newest = made;
        return made;
    } catch (const vk::SystemError& failure) {
        const auto code = static_cast<vk::Result>(failure.code().value());
        const bool no_more = code == vk::Result::eErrorInitializationFailed || code == vk::Result::eErrorTooManyObjects;
        auto shared = no_more ? newest.lock() : nullptr;
        if (!shared) throw;
        return shared;
    }
}

/// A logical device with one queue. It belongs to one session, so that a lost device is lost only to that session; but
/// see made_or_shared(). Contexts of one physical device are used by one thread at a time.
class Context {
public:
    /// Throws Error if the driver fails. tracer: how rays are traced through a BVH of the driver's, if they are;
    /// found.ray_tracing gives no reason against it. Features other than compute are enabled only for sessions that
    /// need them.
    explicit Context(const FoundDevice& found, std::optional<RayTracer> tracer = {});

    [[nodiscard]] const FoundDevice& found() const { return found_; }
    [[nodiscard]] const Device& facts() const { return found_.facts; }
    [[nodiscard]] const vk::raii::Device& device() const { return *device_; }
    [[nodiscard]] const vk::raii::Queue& queue() const { return queue_; }

    /// Where its kernels run: barriers wait for it.
    [[nodiscard]] vk::PipelineStageFlagBits shader_stage() const { return shader_stage_; }

    [[nodiscard]] vk::PhysicalDeviceMemoryProperties memory() const;

    /// A command buffer that can be recorded again and again.
    [[nodiscard]] vk::raii::CommandBuffer make_commands() const;
    void submit(const vk::raii::CommandBuffer& commands) const;
    /// Waits for everything submitted.
    void finish() const;
    /// A query pool for the two times of a piece of work.
    [[nodiscard]] vk::raii::QueryPool make_timestamps() const
    {
        return device_->createQueryPool(
            vk::QueryPoolCreateInfo{}.setQueryType(vk::QueryType::eTimestamp).setQueryCount(2));
    }
    /// Seconds between record_begin_time() and record_end_time(), in commands that have finished.
    [[nodiscard]] double seconds_of(const vk::raii::QueryPool& times) const;

    /// Does some work; an error of the API becomes Error, see to_error(), and a message of the validation layers
    /// becomes Error{internal}. bytes: what the work needs on the device.
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

    /// Throws Error{internal} if the validation layers have sent messages since the last call.
    void check_validation(const std::string& doing) const;

private:
    FoundDevice found_;
    vk::PipelineStageFlagBits shader_stage_;
    std::shared_ptr<vk::raii::Device> device_;
    vk::raii::Queue queue_{nullptr};
    vk::raii::CommandPool pool_{nullptr};
    vk::raii::Fence fence_{nullptr};
};

/// Ticks from begin to end of a counter whose low valid_bits (1 to 64) are defined. Correct even if the counter wrapped
/// once in between.
[[nodiscard]] constexpr std::uint64_t ticks_between(std::uint64_t begin, std::uint64_t end, unsigned valid_bits)
{
    const std::uint64_t mask = valid_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << valid_bits) - 1;
    return (end - begin) & mask;
}

/// Both times are taken when everything recorded or submitted before has ended: overlapping spans of work count once.
void record_begin_time(const vk::raii::CommandBuffer& commands, const vk::raii::QueryPool& times);
void record_end_time(const vk::raii::CommandBuffer& commands, const vk::raii::QueryPool& times);

/// Makes what earlier transfers and kernels wrote visible to later transfers, kernels and the host.
void record_barrier(const Context& context, const vk::raii::CommandBuffer& commands);

} // namespace tetrace::vulkan
