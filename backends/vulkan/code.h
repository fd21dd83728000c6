#pragma once

namespace tetrace::vulkan {

/// A kernel's GLSL with its includes resolved, and the SPIR-V of each of its programs; empty if there is none.
[[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel);

} // namespace tetrace::vulkan

// code/: what drivers report about the code that their compilers make.
#pragma once

#include "backends/vulkan/device.h"

namespace tetrace::vulkan {

/// As Backend::compiled() describes it, through VK_KHR_pipeline_executable_properties. Without a
/// context, whose fence null hardware does not have. Precondition: found has a handle.
[[nodiscard]] CompiledCode compiled_code(const FoundDevice& found, const std::optional<KernelId>& kernel,
                                         bool starts_outside, const std::filesystem::path& program_file);

} // namespace tetrace::vulkan
