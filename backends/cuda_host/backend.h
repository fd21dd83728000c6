#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// The CUDA backend, its launches and its kernels' source, executed on the host. It does not measure any GPU; it tests
/// everything that a GPU would run.
[[nodiscard]] Backend& cuda_host_backend();

} // namespace tetrace
