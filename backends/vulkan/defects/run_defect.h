// defects/: reduced kernels of compilers' defects as Vulkan programs.
#pragma once

#include "backends/vulkan/context.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tetrace::vulkan {

/// Compiles and runs a reduced kernel (core/debugging/defects.h). Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_defect(const Context& context, std::string_view name);

} // namespace tetrace::vulkan
