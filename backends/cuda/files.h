#pragma once

#include "backends/cuda/program.h"

namespace tetrace::cuda {

/// A kernel's source with its includes resolved; its PTX, where NVRTC is here; and what nvcc made of it, where this
/// build has that. Empty where there is no such kernel.
[[nodiscard]] std::vector<KernelFile> kernel_files(const Programs& programs, const KernelId& kernel);

} // namespace tetrace::cuda
