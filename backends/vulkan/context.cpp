#include "backends/vulkan/context.h"

#include "backends/vulkan/instance.h"

#include <array>
#include <limits>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace tetrace::vulkan {

namespace {

vk::raii::PhysicalDevice physical_device(const FoundDevice& found)
{
    return {instance().handle(), found.handle};
}

vk::raii::Device make_device(const FoundDevice& found, std::optional<RayTracer> tracer)
{
    const std::array priorities = {1.0f};
    const auto queue =
        vk::DeviceQueueCreateInfo{}.setQueueFamilyIndex(*found.limits.queue_family).setQueuePriorities(priorities);
    std::vector<const char*> extensions;
    if (found.tells_cache_hits) extensions.push_back(VK_EXT_PIPELINE_CREATION_FEEDBACK_EXTENSION_NAME);
    auto info = vk::DeviceCreateInfo{}.setQueueCreateInfos(queue);
    if (!tracer) return {physical_device(found), info.setPEnabledExtensionNames(extensions)};
    const auto theirs = ray_extensions(*tracer);
    extensions.insert(extensions.end(), theirs.begin(), theirs.end());
    const RayFeatures features = ray_features(*tracer);
    info.setPNext(&features.get<vk::PhysicalDeviceFeatures2>());
    return {physical_device(found), info.setPEnabledExtensionNames(extensions)};
}

std::shared_ptr<vk::raii::Device> device_of(const FoundDevice& found, std::optional<RayTracer> tracer)
{
    static std::mutex mutex;
    static std::map<std::pair<VkPhysicalDevice, std::optional<RayTracer>>, std::weak_ptr<vk::raii::Device>> newest;
    const std::lock_guard lock(mutex);
    return made_or_shared(newest[{found.handle, tracer}], [&] { return make_device(found, tracer); });
}

} // namespace

Context::Context(const FoundDevice& found, std::optional<RayTracer> tracer)
    : found_(found), shader_stage_(tracer == RayTracer::pipeline ? vk::PipelineStageFlagBits::eRayTracingShaderKHR
                                                                 : vk::PipelineStageFlagBits::eComputeShader)
{
    if (!found.facts.usable) throw Error(ErrorKind::missing, found.facts.reason);
    run("opening the device", 0, [&] {
        device_ = device_of(found, tracer);
        queue_ = device_->getQueue(*found.limits.queue_family, 0);
        pool_ = device_->createCommandPool(vk::CommandPoolCreateInfo{}
                                               .setQueueFamilyIndex(*found.limits.queue_family)
                                               .setFlags(vk::CommandPoolCreateFlagBits::eResetCommandBuffer));
        fence_ = device_->createFence({});
    });
}

vk::PhysicalDeviceMemoryProperties Context::memory() const
{
    return physical_device(found_).getMemoryProperties();
}

vk::raii::CommandBuffer Context::make_commands() const
{
    const auto info = vk::CommandBufferAllocateInfo{}.setCommandPool(*pool_).setCommandBufferCount(1);
    return std::move(vk::raii::CommandBuffers(*device_, info).front());
}

void Context::submit(const vk::raii::CommandBuffer& commands) const
{
    const std::array buffers = {*commands};
    queue_.submit(vk::SubmitInfo{}.setCommandBuffers(buffers));
}

void Context::finish() const
{
    // An empty submission's fence signals when all that was submitted before has ended.
    queue_.submit({}, *fence_);
    const vk::Result result = device_->waitForFences(*fence_, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    if (result != vk::Result::eSuccess)
        throw Error(ErrorKind::driver,
                    "waiting for '" + facts().name + "': vkWaitForFences gave " + vk::to_string(result));
    device_->resetFences(*fence_);
}

double Context::seconds_of(const vk::raii::QueryPool& times) const
{
    constexpr auto word = sizeof(std::uint64_t);
    const auto [result, ticks] = times.getResults<std::uint64_t>(
        0, 2, 2 * word, word, vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    if (result != vk::Result::eSuccess)
        throw Error(ErrorKind::driver, "reading timestamps of '" + facts().name + "': vkGetQueryPoolResults gave " +
                                           vk::to_string(result));
    return static_cast<double>(ticks_between(ticks[0], ticks[1], found_.limits.timestamp_bits)) *
           facts().timer_period_s;
}

void Context::check_validation(const std::string& doing) const
{
    const std::string messages = instance().validation_log().take();
    if (!messages.empty())
        throw Error(ErrorKind::internal,
                    "before " + doing + " on '" + facts().name + "' the validation layers said: " + messages);
}

void record_begin_time(const vk::raii::CommandBuffer& commands, const vk::raii::QueryPool& times)
{
    commands.resetQueryPool(*times, 0, 2);
    commands.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *times, 0);
}

void record_end_time(const vk::raii::CommandBuffer& commands, const vk::raii::QueryPool& times)
{
    commands.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *times, 1);
}

void record_barrier(const Context& context, const vk::raii::CommandBuffer& commands)
{
    using Access = vk::AccessFlagBits;
    using Stage = vk::PipelineStageFlagBits;
    const auto barrier =
        vk::MemoryBarrier{}
            .setSrcAccessMask(Access::eShaderWrite | Access::eTransferWrite)
            .setDstAccessMask(Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                              Access::eTransferWrite | Access::eIndirectCommandRead | Access::eHostRead);
    const vk::PipelineStageFlags stages = context.shader_stage() | Stage::eTransfer;
    commands.pipelineBarrier(stages, stages | Stage::eDrawIndirect | Stage::eHost, {}, barrier, {}, {});
}

} // namespace tetrace::vulkan
