// For LD_PRELOAD: a disk that fails. FAULTY_DISK is "<call> <how>", or "<call>:<n> <how>" for the n-th call of its
// kind; calls are write, sync and rename, hows are io (EIO), full (ENOSPC), and for write short: not all bytes are
// taken. Only regular files are on this disk, and the standard streams never are.
#include "tests/isolation/misbehaviour.h"

#include <cerrno>
#include <cstddef>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

bool is_on_disk(int file)
{
    struct stat found {};
    return file > 2 && ::fstat(file, &found) == 0 && S_ISREG(found.st_mode);
}

std::string fault(const char* call, int number)
{
    return tetrace::test::fault_at("FAULTY_DISK", call, number);
}

/// The error that a call has to report; 0: none.
int error_of(const std::string& how)
{
    return how == "io" ? EIO : how == "full" ? ENOSPC : 0;
}

int fail(int error)
{
    errno = error;
    return -1;
}

int sync(int file, long call)
{
    static int calls = 0;
    if (is_on_disk(file))
        if (const int error = error_of(fault("sync", ++calls))) return fail(error);
    return static_cast<int>(::syscall(call, file));
}

} // namespace

extern "C" ssize_t write(int file, const void* bytes, std::size_t count)
{
    static int calls = 0;
    if (is_on_disk(file)) {
        const std::string how = fault("write", ++calls);
        if (const int error = error_of(how)) return fail(error);
        if (how == "short" && count > 1) count = (count + 2) / 3;
    }
    return ::syscall(SYS_write, file, bytes, count);
}

extern "C" int fsync(int file)
{
    return sync(file, SYS_fsync);
}

extern "C" int fdatasync(int file)
{
    return sync(file, SYS_fdatasync);
}

extern "C" int rename(const char* from, const char* to) noexcept
{
    static int calls = 0;
    if (const int error = error_of(fault("rename", ++calls))) return fail(error);
    return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
