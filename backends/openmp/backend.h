#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// The host's cores through OpenMP: the reference that every other backend is compared with.
[[nodiscard]] Backend& openmp_backend();

} // namespace tetrace
