#pragma once

#include "backends/opencl/context.h"

namespace tetrace::opencl {

/// Copy bandwidth of the device's memory and caches by clEnqueueCopyBuffer and its events (core/device/yardstick.h),
/// buffers of 512 MiB at most, less where one may not be that large, bytes read and written; and the median time of an
/// empty kernel from its enqueueing to the end of clFinish on the host's clock. Throws Error if the device fails.
[[nodiscard]] Yardstick measure_device(Context& context, std::uint64_t max_buffer_bytes);

} // namespace tetrace::opencl
