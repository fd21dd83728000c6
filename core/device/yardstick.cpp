#include "core/device/yardstick.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace tetrace {

namespace {

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;
constexpr double enough_s = 3e-3; ///< of a pass: much longer than a launch and the clock's resolution
constexpr std::uint64_t enough_bytes = 128 * mebibyte;
constexpr unsigned max_times = 4096;
constexpr double patient_s = 0.3;
constexpr int max_passes = 6;

/// TETRACE_QUICK_COPIES, which only tests set, limits the copies to 1 MiB and one pass: most tests do not look at the
/// bandwidth, and measuring it well takes a second of each run.
bool is_quick()
{
    return std::getenv("TETRACE_QUICK_COPIES") != nullptr;
}

/// The best of several passes; the first, which may touch pages, does not count.
CopyRate rate_of(std::uint64_t bytes, const CopyTask& copy)
{
    // On a busy machine a thread that waits for its turn may take as long as a pass should.
    auto times = is_quick() ? 1u : static_cast<unsigned>(std::clamp<std::uint64_t>(enough_bytes / bytes, 1, max_times));
    for (double seconds = copy(bytes, times); seconds < enough_s && times < max_times; seconds = copy(bytes, times))
        times *= 2;
    const Stopwatch watch;
    double best_s = copy(bytes, times);
    for (int pass = 1; pass < (is_quick() ? 1 : max_passes) && watch.seconds() < patient_s; ++pass)
        best_s = std::min(best_s, copy(bytes, times));
    return {2 * bytes, best_s > 0 ? 2.0 * static_cast<double>(bytes) * times / best_s : 0};
}

} // namespace

double Yardstick::copy_bytes_per_s_of(std::uint64_t bytes) const
{
    double best = 0;
    for (const CopyRate& copy : copies)
        if (copy.bytes >= bytes) best = std::max(best, copy.bytes_per_s);
    return best > 0 ? best : copy_bytes_per_s;
}

std::uint64_t copied_bytes(std::uint64_t memory_bytes, std::uint64_t max_buffer_bytes)
{
    std::uint64_t bytes = std::min((is_quick() ? 1 : 512) * mebibyte, memory_bytes / 8);
    if (max_buffer_bytes != 0) bytes = std::min(bytes, max_buffer_bytes);
    return bytes & ~std::uint64_t{3};
}

Yardstick measure_copies(std::uint64_t bytes, const CopyTask& copy)
{
    if (bytes == 0) throw Error(ErrorKind::unsupported, "measuring the device: no buffer may be as large as a word");
    Yardstick measured;
    std::size_t sizes = 0;
    for (std::uint64_t each = mebibyte / 2; each < bytes && sizes + 1 < measured.copies.size(); each *= 4)
        measured.copies[sizes++] = rate_of(each, copy);
    measured.copies[sizes] = rate_of(bytes, copy);
    measured.copy_bytes_per_s = measured.copies[sizes].bytes_per_s;
    return measured;
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
