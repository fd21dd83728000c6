#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <functional>

namespace tetrace {

/// Bytes of each of the two buffers for measuring a device's memory by copying, the same for every API: far more than
/// its caches hold (50 MB on an H200, 96 MB on an RTX 4090, 384 MB on an EPYC 9684X), at most an eighth of its memory,
/// whole words. memory_bytes: of the device, or what is free of it. max_buffer_bytes: of the API; 0 is not a limit.
[[nodiscard]] std::uint64_t copied_bytes(std::uint64_t memory_bytes, std::uint64_t max_buffer_bytes);

/// Copies the first bytes of one buffer to another this many times, and returns the device's seconds for all of them.
using CopyTask = std::function<double(std::uint64_t bytes, unsigned times)>;

/// Measures copies of 1 MiB, 4 MiB and so on up to both buffers whole: the best of several passes, each of them long
/// enough for the device's clock. bytes: of each of the two buffers. The launch time is left to the caller.
[[nodiscard]] Yardstick measure_copies(std::uint64_t bytes, const CopyTask& copy);

/// Median of the seconds that some work takes on the host's clock: single runs are disturbed by other processes.
[[nodiscard]] double median_seconds(const std::function<void()>& work);

} // namespace tetrace
