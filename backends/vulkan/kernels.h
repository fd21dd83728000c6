#pragma once

#include "backends/embedded.h"

namespace tetrace::vulkan {

/// The SPIR-V of each program: embedded_name() of a kernel, with "_search" behind it for that task, "_texels" where the
/// scene is read as such, "_parts" where the tets come in several buffers; "probe_exact", "probe_fast" and "empty".
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

} // namespace tetrace::vulkan
