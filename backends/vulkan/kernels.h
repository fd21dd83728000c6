#pragma once

#include "backends/embedded.h"

namespace tetrace::vulkan {

/// The SPIR-V of each program: embedded_name() of a kernel followed by its task, "_texels" where the scene is read as
/// texels, "_parts" where the tets are in several buffers (task trace only); "single_rt_fast_trace" and
/// "single_rt_fast_rays", which need ray queries; "probe_exact", "probe_fast" and "empty".
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

/// The name of the kernel's program that reads each array from one storage buffer.
[[nodiscard]] inline std::string shader_name(const KernelId& kernel)
{
    return embedded_name(kernel).append("_").append(name_of(kernel.task));
}

} // namespace tetrace::vulkan
