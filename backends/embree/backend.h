#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// Intel's Embree on the host's cores: the BVH that CDT rows are compared with on the CPU.
[[nodiscard]] Backend& embree_backend();

} // namespace tetrace
