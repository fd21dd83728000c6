#include "core/base/files.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <utility>

namespace tetrace {

std::filesystem::path temporary_name(const std::filesystem::path& path)
{
    static std::atomic<unsigned> number{0};
    std::filesystem::path name = path;
    std::string ending = ".";
    ending.append(std::to_string(::getpid())).append("-").append(std::to_string(number.fetch_add(1))).append(".tmp");
    name += ending;
    return name;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path))
{
    // A name may be left over from a killed process that had our number; the next one is then free.
    do {
        temporary_ = temporary_name(path_);
        file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file_ < 0 && errno == EEXIST);
    if (file_ < 0) fail("creating a temporary file for it");
    struct stat before {};
    if (::stat(path_.c_str(), &before) == 0) static_cast<void>(::fchmod(file_, before.st_mode & 0777u));
}

AtomicFile::~AtomicFile()
{
    if (file_ < 0) return;
    ::close(file_);
    ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(file_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("writing its content");
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit()
{
    if (::fsync(file_) != 0) fail("syncing its content");
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("renaming the finished file to it");
    ::close(std::exchange(file_, -1));
    // The rename itself survives a power cut only once the folder is synced; not every file system can, and none must.
    const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
    const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory < 0) return;
    ::fsync(directory);
    ::close(directory);
}

void AtomicFile::fail(const char* doing) const
{
    const int reason = errno;
    throw Error(ErrorKind::invalid_input, "writing " + path_.string() + ": " + doing + ": " + std::strerror(reason) +
                                              "; check that the folder exists, may be written to and has space left");
}

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

std::optional<std::string> file_bytes(const std::filesystem::path& path, std::size_t most)
{
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.open()) return std::nullopt;
    std::string bytes;
    std::array<char, 1 << 16> piece{};
    while (bytes.size() < most) {
        const ssize_t count = ::read(file.get(), piece.data(), std::min(piece.size(), most - bytes.size()));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return std::nullopt;
        if (count == 0) break;
        bytes.append(piece.data(), static_cast<std::size_t>(count));
    }
    return bytes;
}

std::string required_bytes(const std::filesystem::path& path)
{
    auto bytes = file_bytes(path);
    if (!bytes) throw Error(ErrorKind::missing, "the file '" + path.string() + "' cannot be read");
    return std::move(*bytes);
}

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
