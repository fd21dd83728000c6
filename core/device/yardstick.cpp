#include "core/device/yardstick.h"

#include "core/base/stopwatch.h"

#include <algorithm>
#include <vector>

namespace tetrace {

std::uint64_t copied_bytes(const Device& device, std::uint64_t max_buffer_bytes)
{
    constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;
    std::uint64_t bytes = (device.kind == DeviceKind::gpu ? 512 : 128) * mebibyte;
    bytes = std::min(bytes, device.memory_bytes / 4);
    if (max_buffer_bytes != 0) bytes = std::min(bytes, max_buffer_bytes);
    return bytes & ~std::uint64_t{3};
}

double median_seconds(const std::function<void()>& work)
{
    constexpr std::size_t times = 101;
    std::vector<double> seconds;
    for (std::size_t i = 0; i < times; ++i) {
        const Stopwatch watch;
        work();
        seconds.push_back(watch.seconds());
    }
    std::nth_element(seconds.begin(), seconds.begin() + times / 2, seconds.end());
    return seconds[times / 2];
}

} // namespace tetrace
