#pragma once

#include "core/device/defects.h"

#include <span>

namespace tetrace {

/// Those of all_defects() that are stressors, the kernels of kernels/defects/stressors.h.
[[nodiscard]] std::span<const Defect> all_stressors();

} // namespace tetrace
