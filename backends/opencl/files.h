#pragma once

namespace tetrace::opencl {

/// A kernel's source with its includes resolved; empty if there is none.
[[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel);

} // namespace tetrace::opencl
