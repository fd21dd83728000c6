#pragma once

#include "backends/cuda/device.h"
#include "core/device/backend.h"

namespace tetrace::cuda {

/// Copies memory to memory, up to 512 MiB and for some milliseconds at most, and takes the best of a few; then launches
/// a kernel that has nothing to do. probe: of the self-test's module.
[[nodiscard]] Yardstick measure_device(OpenDevice& device, FunctionHandle probe);

} // namespace tetrace::cuda
