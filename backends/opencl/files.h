#pragma once

namespace tetrace::opencl {

/// A kernel's source with its includes resolved; empty where there is none.
[[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel);

} // namespace tetrace::opencl
