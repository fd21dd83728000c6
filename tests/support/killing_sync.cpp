// For LD_PRELOAD: kills the process at the end of its fdatasync() of the number TETRACE_KILLED_AT_SYNC. The journal is
// all that tetrace writes so, an entry a call, so that a run is killed with that many lines, however busy the machine.
#include <csignal>
#include <cstdlib>
#include <sys/syscall.h>
#include <unistd.h>

extern "C" int fdatasync(int file)
{
    static int left =
        std::getenv("TETRACE_KILLED_AT_SYNC") == nullptr ? 0 : std::atoi(std::getenv("TETRACE_KILLED_AT_SYNC"));
    const long result = ::syscall(SYS_fdatasync, file);
    if (left > 0 && --left == 0) ::kill(::getpid(), SIGKILL);
    return static_cast<int>(result);
}
