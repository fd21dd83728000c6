#include "scenes/file_lock.h"

#include "core/base/error.h"
#include "core/base/try_lock.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tetrace {

namespace {

/// Whether the path still leads to the open file: its last owner may have removed it between our open and our lock.
bool still_there(const std::filesystem::path& path, int file)
{
    struct stat opened {
    }, named{};
    return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

} // namespace

FileLock::FileLock(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}

FileLock::FileLock(FileLock&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

FileLock::~FileLock()
{
    if (file_ < 0) return;
    ::unlink(path_.c_str()); // before the lock is released, so that no process locks a file that is about to vanish
    ::close(file_);
}

bool FileLock::is_held(const std::filesystem::path& path)
{
    const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return false;
    const bool held = try_lock(file) == LockAttempt::held;
    ::close(file);
    return held;
}

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& path)
{
    for (;;) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        const LockAttempt attempt = file >= 0 ? try_lock(file) : LockAttempt::failed;
        if (attempt == LockAttempt::taken) {
            FileLock lock(path, file);
            if (still_there(path, file)) return lock;
            ::close(std::exchange(lock.file_, -1));
            continue;
        }
        const int reason = errno;
        if (file >= 0) ::close(file);
        if (attempt == LockAttempt::held) return std::nullopt;
        if (reason != EINTR)
            throw Error(ErrorKind::invalid_input, fmt::format("locking {}: {}; check that its folder may be written to",
                                                              path.string(), std::strerror(reason)));
    }
}

} // namespace tetrace
