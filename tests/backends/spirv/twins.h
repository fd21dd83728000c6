#pragma once

#include "backends/embedded.h"

namespace tetrace::twins {

/// SPIR-V that the checks must reject.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

} // namespace tetrace::twins
