#include "backends/vulkan/pass_order.h"

#include <array>

namespace tetrace::vulkan {

namespace {

/// When all have been used, a barrier waits for all passes so far.
constexpr std::uint32_t max_events = 256;

} // namespace

void PassOrder::record_begin(const vk::raii::CommandBuffer& commands, std::uint32_t pass, std::uint32_t in_flight)
{
    using Access = vk::AccessFlagBits;
    using Stage = vk::PipelineStageFlagBits;
    const std::uint32_t number = pass % max_events;
    if (in_flight == 1) {
        if (pass > 0) record_barrier(*context_, commands);
    } else if (number == 0) {
        record_reset(commands);
    } else if (number >= in_flight) {
        const auto written = vk::MemoryBarrier{}
                                 .setSrcAccessMask(Access::eShaderWrite)
                                 .setDstAccessMask(Access::eShaderRead | Access::eShaderWrite | Access::eTransferWrite);
        const std::array<vk::Event, 1> ended = {*events_[number - in_flight]};
        commands.waitEvents(ended, context_->shader_stage(), context_->shader_stage() | Stage::eTransfer, written, {},
                            {});
    }
}

void PassOrder::record_end(const vk::raii::CommandBuffer& commands, std::uint32_t pass, std::uint32_t in_flight) const
{
    if (in_flight > 1) commands.setEvent(*events_[pass % max_events], context_->shader_stage());
}

/// No pass still waits for an event, and none sets one that is reset later. Setting and resetting belong to no stage,
/// so barriers wait for all.
void PassOrder::record_reset(const vk::raii::CommandBuffer& commands)
{
    constexpr auto all = vk::PipelineStageFlagBits::eAllCommands;
    while (events_.size() < max_events)
        events_.push_back(context_->device().createEvent({}));
    record_barrier(*context_, commands);
    commands.pipelineBarrier(all, all, {}, {}, {}, {});
    for (const vk::raii::Event& event : events_)
        commands.resetEvent(*event, context_->shader_stage());
    commands.pipelineBarrier(all, all, {}, {}, {}, {});
}

} // namespace tetrace::vulkan
