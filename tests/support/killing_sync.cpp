// For LD_PRELOAD: kills the process at the end of its fdatasync() of the number TETRACE_KILLED_AT_SYNC of a journal, or
// sends it the signal of the number TETRACE_SYNC_SIGNAL instead. A journal is written so entry by entry: the run gets
// the signal with that many lines, however busy the machine. What a driver syncs in its own process does not count.
#include <csignal>
#include <cstdlib>
#include <string>
#include <string_view>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

bool is_journal(int file)
{
    char path[4096];
    const ssize_t length = ::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, sizeof path);
    return length > 0 && std::string_view(path, static_cast<std::size_t>(length)).ends_with(".journal");
}

} // namespace

extern "C" int fdatasync(int file)
{
    static int left =
        std::getenv("TETRACE_KILLED_AT_SYNC") == nullptr ? 0 : std::atoi(std::getenv("TETRACE_KILLED_AT_SYNC"));
    const long result = ::syscall(SYS_fdatasync, file);
    const char* const number = std::getenv("TETRACE_SYNC_SIGNAL");
    if (left > 0 && is_journal(file) && --left == 0)
        ::kill(::getpid(), number != nullptr ? std::atoi(number) : SIGKILL);
    return static_cast<int>(result);
}
