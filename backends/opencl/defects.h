#pragma once

#include "backends/opencl/context.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tetrace::opencl {

/// Compiles and runs a reduced kernel (core/debugging/defects.h). Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_defect(Context& context, std::string_view name);

} // namespace tetrace::opencl
