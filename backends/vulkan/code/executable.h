// code/: what drivers report about the code that their compilers make.
#pragma once

#include "backends/vulkan/device.h"

namespace tetrace::vulkan {

/// As Backend::compiled() describes it, through VK_KHR_pipeline_executable_properties. Without a
/// context, whose fence null hardware does not have. Precondition: found has a handle.
[[nodiscard]] CompiledCode compiled_code(const FoundDevice& found, const std::optional<KernelId>& kernel,
                                         bool starts_outside);

} // namespace tetrace::vulkan
