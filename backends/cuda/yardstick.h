#pragma once

#include "backends/cuda/device.h"
#include "core/device/backend.h"

namespace tetrace::cuda {

/// Copies memory to memory, up to 512 MiB but no longer than some milliseconds, the best of a few, and launches a
/// kernel that has nothing to do. probe: of the self-test's module.
[[nodiscard]] Yardstick measure_device(OpenDevice& device, FunctionHandle probe);

} // namespace tetrace::cuda
