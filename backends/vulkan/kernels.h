#pragma once

#include "backends/embedded.h"

namespace tetrace::vulkan {

/// The SPIR-V of each program: embedded_name() of a kernel with its task behind it, "_texels" where the scene is read
/// as such, "_parts" where the tets come in several buffers (task trace alone); "single_rt_fast_trace" and
/// "single_rt_fast_rays", which need ray queries; "probe_exact", "probe_fast" and "empty".
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

/// The name of a kernel's program that reads the scene from buffers, each array from one.
[[nodiscard]] inline std::string shader_name(const KernelId& kernel)
{
    return embedded_name(kernel).append("_").append(name_of(kernel.task));
}

} // namespace tetrace::vulkan
