#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <functional>

namespace tetrace {

/// Bytes of each of the two buffers for measuring a device's memory by copying, the same for every API: far more than
/// its caches hold (50 MB on an H200, 96 MB on an RTX 4090), at most a quarter of its memory, whole words.
/// max_buffer_bytes: of the API; 0 is no limit.
[[nodiscard]] std::uint64_t copied_bytes(const Device& device, std::uint64_t max_buffer_bytes);

/// Median of the seconds that some work takes on the host's clock: single runs are disturbed by other processes.
[[nodiscard]] double median_seconds(const std::function<void()>& work);

} // namespace tetrace
