#include "core/base/atomic_file.h"

#include "core/base/error.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
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

} // namespace tetrace
