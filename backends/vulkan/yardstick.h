#pragma once

#include "backends/vulkan/context.h"

namespace tetrace::vulkan {

/// Copy bandwidth of the device's memory, the best of a few vkCmdCopyBuffer of 128 MiB (less where a buffer may not be
/// that large) by timestamps, bytes read and written; and the median time of an empty kernel from vkQueueSubmit to its
/// fence on the host's clock. Throws Error where the device fails.
[[nodiscard]] Yardstick measure_device(const Context& context, std::uint64_t max_buffer_bytes);

} // namespace tetrace::vulkan
