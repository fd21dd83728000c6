#include "core/isolation/channel.h"

#include "core/base/control_groups.h"
#include "core/base/error.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace tetrace {

namespace {

[[noreturn]] void fail(std::size_t bytes, int reason)
{
    throw Error(ErrorKind::unsupported,
                "no " + std::to_string(bytes) + " bytes of memory to share with a driver's process: " +
                    std::strerror(reason) + memory_limit_text() + "; use a smaller --size or fewer rows");
}

} // namespace

SharedMemory::SharedMemory(std::size_t bytes)
{
    if (bytes == 0) return;
    if (!fits_in_memory(bytes)) fail(bytes, ENOMEM);
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

namespace {

/// The arguments of sendmsg() and recvmsg(): one piece of memory, and space for one file.
class Envelope {
public:
    Envelope(void* bytes, std::size_t count) : piece_{bytes, count}
    {
        header_.msg_iov = &piece_;
        header_.msg_iovlen = 1;
        header_.msg_control = control_.data();
        header_.msg_controllen = control_.size();
    }
    void put_file(int file)
    {
        if (file < 0) {
            header_.msg_control = nullptr;
            header_.msg_controllen = 0;
            return;
        }
        cmsghdr* const control = CMSG_FIRSTHDR(&header_);
        control->cmsg_level = SOL_SOCKET;
        control->cmsg_type = SCM_RIGHTS;
        control->cmsg_len = CMSG_LEN(sizeof file);
        std::memcpy(CMSG_DATA(control), &file, sizeof file);
    }
    [[nodiscard]] Descriptor take_file()
    {
        const cmsghdr* const control = CMSG_FIRSTHDR(&header_);
        if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return Descriptor();
        int file = -1;
        std::memcpy(&file, CMSG_DATA(control), sizeof file);
        return Descriptor(file);
    }
    [[nodiscard]] msghdr* header() { return &header_; }

private:
    iovec piece_;
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control_{};
    msghdr header_{};
};

} // namespace

Channel::Pair Channel::make_pair()
{
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw Error(ErrorKind::driver, std::string("no socket for a driver's process: ") + std::strerror(errno));
    return {Channel(Descriptor(ends[0])), Channel(Descriptor(ends[1]))};
}

bool Channel::send(std::span<const std::byte> bytes, int file) const
{
    if (bytes.size() > max_message_bytes)
        throw Error(ErrorKind::internal, "a message of " + std::to_string(bytes.size()) +
                                             " bytes for a driver's process, at most " +
                                             std::to_string(max_message_bytes) + " are possible");
    Envelope envelope(const_cast<std::byte*>(bytes.data()), bytes.size()); // sendmsg() only reads
    envelope.put_file(file);
    ssize_t sent = 0;
    while ((sent = ::sendmsg(socket_.get(), envelope.header(), MSG_NOSIGNAL)) < 0 && errno == EINTR) {
    }
    return sent == static_cast<ssize_t>(bytes.size());
}

bool Channel::wait(int milliseconds) const
{
    pollfd end = {socket_.get(), POLLIN, 0};
    return ::poll(&end, 1, milliseconds) > 0;
}

std::optional<Message> Channel::receive() const
{
    buffer_.resize(max_message_bytes);
    Envelope envelope(buffer_.data(), buffer_.size());
    ssize_t got = 0;
    while ((got = ::recvmsg(socket_.get(), envelope.header(), MSG_CMSG_CLOEXEC)) < 0 && errno == EINTR) {
    }
    if (got <= 0) return std::nullopt;
    return Message{{buffer_.begin(), buffer_.begin() + got}, envelope.take_file()};
}

} // namespace tetrace
