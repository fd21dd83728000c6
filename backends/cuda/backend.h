#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// NVIDIA's devices through the CUDA driver API, whose library is loaded when the devices are first asked for.
[[nodiscard]] Backend& cuda_backend();

} // namespace tetrace
