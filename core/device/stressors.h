#pragma once

#include "core/device/defects.h"

#include <span>

namespace tetrace {

/// Those of all_defects() that are kernels of kernels/defects/stressors.h.
[[nodiscard]] std::span<const Defect> all_stressors();

/// Those that are kernels of kernels/defects/group_stressors.h, lane_stressors.h and far_stressors.h.
[[nodiscard]] std::span<const Defect> group_stressors();

} // namespace tetrace
