#pragma once

#include "backends/opencl/context.h"
#include "core/pack/kernel_id.h"

#include <optional>

namespace tetrace::opencl {

/// As Backend::compiled() describes it: what clGetKernelWorkGroupInfo() reports, under the names of its parameters, and
/// from NVIDIA's driver ptxas's report as messages. That driver says nothing if it takes the program from its own
/// cache; CUDA_CACHE_DISABLE=1 turns it off.
[[nodiscard]] CompiledCode compiled_code(Context& context, const std::optional<KernelId>& kernel, bool starts_outside);

} // namespace tetrace::opencl
