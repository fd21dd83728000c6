// For LD_PRELOAD: kills the process at the end of its fdatasync() of the number TETRACE_KILLED_AT_SYNC, or sends it the
// signal of the number TETRACE_SYNC_SIGNAL instead. Only the journal is written so, one entry per call: the run gets
// the signal with that many lines, however busy the machine.
#include <csignal>
#include <cstdlib>
#include <sys/syscall.h>
#include <unistd.h>

extern "C" int fdatasync(int file)
{
    static int left =
        std::getenv("TETRACE_KILLED_AT_SYNC") == nullptr ? 0 : std::atoi(std::getenv("TETRACE_KILLED_AT_SYNC"));
    const long result = ::syscall(SYS_fdatasync, file);
    const char* const number = std::getenv("TETRACE_SYNC_SIGNAL");
    if (left > 0 && --left == 0) ::kill(::getpid(), number != nullptr ? std::atoi(number) : SIGKILL);
    return static_cast<int>(result);
}
