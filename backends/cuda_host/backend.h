#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// The CUDA backend, its launches and its kernels' source, executed on the host: no measure of any GPU, but a test of
/// all that a GPU would run.
[[nodiscard]] Backend& cuda_host_backend();

} // namespace tetrace
