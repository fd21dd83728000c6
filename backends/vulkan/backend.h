#pragma once

#include "core/device/backend.h"

namespace tetrace {

/// Every device of every Vulkan driver that the machine's loader knows.
[[nodiscard]] Backend& vulkan_backend();

} // namespace tetrace
