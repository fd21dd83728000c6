#pragma once

#include "backends/embedded.h"

namespace tetrace::vulkan {

/// The SPIR-V of each program: embedded_name() of a kernel followed by its task, "_texels" where the scene is read as
/// texels, "_leaves_texels" and "_left_texels" if rays at ties are deferred and traced (docs/spec/devices.md, W9),
/// "_parts" where the tets are in several buffers (task trace only); of layout rt, "_pipeline" for the ray generation
/// shader of a ray-tracing pipeline, and rt_miss and rt_hit; "probe_exact", "probe_fast" and "empty".
[[nodiscard]] std::span<const EmbeddedKernel> embedded_kernels();

/// What a ray-tracing pipeline runs for rays that meet nothing, and for their hits.
inline constexpr const char *rt_miss = "single_rt_fast_miss", *rt_hit = "single_rt_fast_hit";

/// The name of the kernel's program that reads each array from one storage buffer.
[[nodiscard]] inline std::string shader_name(const KernelId& kernel)
{
    const char* const variant = kernel.schedule == Schedule::pipeline ? "_pipeline" : "";
    return embedded_name(kernel).append("_").append(name_of(kernel.task)).append(variant);
}

} // namespace tetrace::vulkan
