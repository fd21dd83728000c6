#include "core/isolation/shared_memory.h"

#include "core/base/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>

namespace tetrace {

namespace {

[[noreturn]] void fail(std::size_t bytes, int reason)
{
    throw Error(ErrorKind::unsupported, "no " + std::to_string(bytes) +
                                            " bytes of memory to share with a driver's process: " +
                                            std::strerror(reason) + "; use a smaller --size or fewer rows");
}

} // namespace

SharedMemory::SharedMemory(std::size_t bytes)
{
    if (bytes == 0) return;
    file_ = Descriptor(::memfd_create("tetrace", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!file_.open()) fail(bytes, errno);
    // All of it now: memory that is missing later would be a signal instead of an error.
    int reason = EINTR;
    while (reason == EINTR)
        reason = ::posix_fallocate(file_.get(), 0, static_cast<off_t>(bytes));
    if (reason != 0) fail(bytes, reason);
    ::fcntl(file_.get(), F_ADD_SEALS, F_SEAL_SHRINK); // the other process cannot take it away from under us
    map(bytes);
}

SharedMemory::SharedMemory(Descriptor file, std::size_t bytes) : file_(std::move(file))
{
    if (bytes == 0) return;
    struct stat facts {};
    if (::fstat(file_.get(), &facts) != 0 || static_cast<std::size_t>(facts.st_size) < bytes)
        throw Error(ErrorKind::internal, "the memory shared with tetrace has fewer than " + std::to_string(bytes) +
                                             " bytes, or was not sent");
    map(bytes);
}

void SharedMemory::map(std::size_t bytes)
{
    void* const place = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_.get(), 0);
    if (place == MAP_FAILED) fail(bytes, errno);
    bytes_ = {static_cast<std::byte*>(place), bytes};
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : file_(std::move(other.file_)), bytes_(std::exchange(other.bytes_, {}))
{
}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept
{
    std::swap(file_, other.file_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

SharedMemory::~SharedMemory()
{
    if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
}

} // namespace tetrace
