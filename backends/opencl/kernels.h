#pragma once

#include "backends/embedded.h"

namespace tetrace::opencl {

/// The source of each program: method_layout ("maria_tet80"), "probe" and "defects"; and "run_case", the host of a
/// LaunchCase.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

} // namespace tetrace::opencl
