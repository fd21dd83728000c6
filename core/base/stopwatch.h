#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>

namespace tetrace {

/// Seconds on the host's steady clock since it was made.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Seconds of processor time of this process, all its threads together, since it was made: the same work takes the same
/// on a busy machine.
class ProcessorStopwatch {
public:
    [[nodiscard]] double seconds() const { return static_cast<double>(now() - start_) * 1e-9; }

private:
    static std::int64_t now()
    {
        timespec time{};
        ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
    }

    std::int64_t start_ = now();
};

} // namespace tetrace
