// For LD_PRELOAD: a clock of the day that somebody sets again and again, by a day to and fro and by years. The clock
// that only counts on (CLOCK_MONOTONIC) is unchanged: nobody can set it.
#include <ctime>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

time_t jump()
{
    static unsigned calls = 0;
    constexpr time_t day = 86'400;
    constexpr time_t jumps[] = {0, day, -day, 20 * 365 * day, -20 * 365 * day};
    return jumps[calls++ % 5];
}

} // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* now) noexcept
{
    const long result = ::syscall(SYS_clock_gettime, clock, now);
    if (result == 0 && clock == CLOCK_REALTIME) now->tv_sec += jump();
    return static_cast<int>(result);
}

extern "C" int gettimeofday(timeval* now, void*) noexcept
{
    timespec precise{};
    const int result = clock_gettime(CLOCK_REALTIME, &precise);
    now->tv_sec = precise.tv_sec;
    now->tv_usec = precise.tv_nsec / 1000;
    return result;
}

extern "C" time_t time(time_t* now) noexcept
{
    timespec precise{};
    clock_gettime(CLOCK_REALTIME, &precise);
    if (now != nullptr) *now = precise.tv_sec;
    return precise.tv_sec;
}
