#pragma once

#include "backends/embedded.h"

namespace tetrace::defects {

/// The SPIR-V of each tests/defects/<name>.comp.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

} // namespace tetrace::defects
