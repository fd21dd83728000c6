#pragma once

namespace tetrace::vulkan {

/// A kernel's GLSL with its includes resolved, and the SPIR-V of each of its programs; empty if there is none.
[[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel);

} // namespace tetrace::vulkan
