#pragma once

#include "backends/vulkan/context.h"

#include <cstdint>
#include <vector>

namespace tetrace::vulkan {

/// Records in which order the passes of a launch run: each waits for the end of the one that is `in_flight` before it.
/// A barrier would wait for all; so if several passes are in flight together, each sets an event when it ends.
class PassOrder {
public:
    explicit PassOrder(const Context& context) : context_(&context) {}
    /// Before the dispatches of a pass. pass: its number in these commands.
    void record_begin(const vk::raii::CommandBuffer& commands, std::uint32_t pass, std::uint32_t in_flight);
    /// After them.
    void record_end(const vk::raii::CommandBuffer& commands, std::uint32_t pass, std::uint32_t in_flight) const;

private:
    void record_reset(const vk::raii::CommandBuffer& commands);

    const Context* context_;
    std::vector<vk::raii::Event> events_; ///< used in turn; made when first needed
};

} // namespace tetrace::vulkan
