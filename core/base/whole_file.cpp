#include "core/base/whole_file.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <span>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, int reason)
{
    throw Error(ErrorKind::invalid_input, "writing " + path.string() + ": " + std::strerror(reason) +
                                              "; check that it may be written to and that the disk is not full");
}

fs::path folder_of(const fs::path& path)
{
    return path.has_parent_path() ? path.parent_path() : ".";
}

/// A regular file in a folder of the same file system that takes new files.
bool is_replaceable(const fs::path& path, const struct stat& file)
{
    struct stat folder {};
    return S_ISREG(file.st_mode) && ::stat(folder_of(path).c_str(), &folder) == 0 && folder.st_dev == file.st_dev &&
           ::access(folder_of(path).c_str(), W_OK | X_OK) == 0;
}

void write_in_place(const fs::path& path, std::string_view bytes)
{
    const int file = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (file < 0) fail(path, errno);
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            const int reason = errno;
            ::close(file);
            fail(path, reason);
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    // Devices and pipes cannot be synced, and need not be.
    const bool synced = ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;
    const int reason = errno;
    const bool closed = ::close(file) == 0;
    if (!synced || !closed) fail(path, synced ? errno : reason);
}

/// The file that is written to, and whether it is replaced.
struct Target {
    fs::path path;
    bool replaced = true;
};

Target target_of(const fs::path& path)
{
    struct stat file {};
    if (::stat(path.c_str(), &file) != 0) return {path};
    if (S_ISDIR(file.st_mode)) fail(path, EISDIR);
    if (!S_ISREG(file.st_mode)) return {path, false};
    const fs::path followed = fs::canonical(path);
    return {followed, is_replaceable(followed, file)};
}

} // namespace

void write_whole(const fs::path& path, std::string_view bytes)
{
    const Target target = target_of(path);
    if (!target.replaced) return write_in_place(target.path, bytes);
    AtomicFile file(target.path);
    file.write(std::as_bytes(std::span(bytes)));
    file.commit();
}

void require_writable(const fs::path& path)
{
    const Target target = target_of(path);
    if (target.replaced) return static_cast<void>(AtomicFile(target.path)); // removed again, since nothing commits it
    if (::access(target.path.c_str(), W_OK) != 0) fail(path, errno);
}

} // namespace tetrace
