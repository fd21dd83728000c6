#pragma once

#include "core/base/stopwatch.h"
#include "core/device/backend.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tetrace {

/// Bytes of each of the two buffers that are copied to measure a device's memory, whichever API measures it: far more
/// than its caches hold (50 MB on an H200, 96 MB on an RTX 4090), a quarter of its memory at most, whole words.
/// max_buffer_bytes: of the API; 0 is no limit.
[[nodiscard]] inline std::uint64_t copied_bytes(const Device& device, std::uint64_t max_buffer_bytes)
{
    constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;
    std::uint64_t bytes = (device.kind == DeviceKind::gpu ? 512 : 128) * mebibyte;
    bytes = std::min(bytes, device.memory_bytes / 4);
    if (max_buffer_bytes != 0) bytes = std::min(bytes, max_buffer_bytes);
    return bytes & ~std::uint64_t{3};
}

/// Median of the seconds that some work takes on the host's clock, which is stolen from now and then.
template <class Work>
[[nodiscard]] double median_seconds(const Work& work)
{
    constexpr std::size_t times = 101;
    std::vector<double> seconds;
    for (std::size_t i = 0; i < times; i++) {
        const Stopwatch watch;
        work();
        seconds.push_back(watch.seconds());
    }
    std::nth_element(seconds.begin(), seconds.begin() + times / 2, seconds.end());
    return seconds[times / 2];
}

} // namespace tetrace
