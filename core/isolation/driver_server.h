#pragma once

#include "core/device/backend.h"

#include <string>
#include <vector>

namespace tetrace {

/// The number of the socket in a driver's process.
inline constexpr int served_socket = 3;

/// What a driver's process does: it answers the requests for one of the backends (DriverChild starts it) until the
/// process that asks is gone. Returns the exit code.
/// arguments: the backend's name, and the number of the process that asks, which may be gone already.
[[nodiscard]] int serve_driver(const std::vector<std::string>& arguments, const std::vector<Backend*>& backends);

} // namespace tetrace
