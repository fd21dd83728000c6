#pragma once

#include "backends/cuda/program.h"

namespace tetrace::cuda {

/// A kernel's source with its includes resolved; its PTX, if NVRTC is here; and nvcc's code, if this build has that.
/// Empty if there is no such kernel.
[[nodiscard]] std::vector<KernelFile> kernel_files(const Programs& programs, const KernelId& kernel);

} // namespace tetrace::cuda
