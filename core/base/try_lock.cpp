#include "core/base/try_lock.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>

namespace tetrace {

LockAttempt try_lock(int file)
{
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(file, F_OFD_SETLK, &whole) == 0) return LockAttempt::taken;
    if (errno == EAGAIN || errno == EACCES) return LockAttempt::held;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return LockAttempt::taken;
    return errno == EWOULDBLOCK ? LockAttempt::held : LockAttempt::failed;
}

} // namespace tetrace
