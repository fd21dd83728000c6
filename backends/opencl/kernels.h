#pragma once

#include "backends/embedded.h"

namespace tetrace::opencl {

/// The source of each program: method_layout ("maria_tet80"), "probe" and "defects".
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

} // namespace tetrace::opencl
