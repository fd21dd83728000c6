#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// Every device of every OpenCL platform that the machine's ICD loader knows.
[[nodiscard]] Backend& opencl_backend();

} // namespace tetrace
