#pragma once

#include "backends/vulkan/context.h"

namespace tetrace::vulkan {

/// Copy bandwidth of the device's memory and caches by vkCmdCopyBuffer and timestamps (core/device/yardstick.h),
/// buffers of 512 MiB at most, less where one may not be that large, bytes read and written; and the median time of an
/// empty kernel from vkQueueSubmit to its fence on the host's clock. Throws Error if the device fails.
[[nodiscard]] Yardstick measure_device(const Context& context, std::uint64_t max_buffer_bytes);

} // namespace tetrace::vulkan
