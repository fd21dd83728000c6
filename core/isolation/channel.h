#pragma once

#include "core/base/files.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tetrace {

/// Memory that two processes see: a file without a name, mapped.
class SharedMemory {
public:
    SharedMemory() = default;
    /// Zeros. Throws Error{unsupported} naming the size if memory is not sufficient.
    explicit SharedMemory(std::size_t bytes);
    /// Maps what the other process made. Throws Error{internal} if the file has fewer bytes.
    SharedMemory(Descriptor file, std::size_t bytes);
    SharedMemory(SharedMemory&& other) noexcept;
    SharedMemory& operator=(SharedMemory&& other) noexcept;
    ~SharedMemory();

    /// To be sent with a message; -1 without memory.
    [[nodiscard]] int file() const { return file_.get(); }
    [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }

private:
    void map(std::size_t bytes);

    Descriptor file_;
    std::span<std::byte> bytes_;
};

/// Bytes, and a file that goes with them.
struct Message {
    std::vector<std::byte> bytes;
    Descriptor file; ///< closed where there is none
};

/// The largest message; what may be larger goes through SharedMemory.
inline constexpr std::size_t max_message_bytes = 128 * 1024;

/// One end of a socket for whole messages.
class Channel {
public:
    explicit Channel(Descriptor socket) : socket_(std::move(socket)) {}

    /// Two connected ends; other programs that are started do not inherit them. Throws Error{driver}.
    struct Pair;
    [[nodiscard]] static Pair make_pair();

    /// file: goes with the message; -1 for none. False if the other end is closed. Throws Error{internal} for a
    /// message above max_message_bytes.
    [[nodiscard]] bool send(std::span<const std::byte> bytes, int file = -1) const;
    /// Whether receive() would return at once. Waits up to that long.
    [[nodiscard]] bool wait(int milliseconds) const;
    /// The next message; empty if the other end is closed.
    [[nodiscard]] std::optional<Message> receive() const;

    [[nodiscard]] int number() const { return socket_.get(); }

private:
    Descriptor socket_;
    mutable std::vector<std::byte> buffer_; ///< of receive()
};

struct Channel::Pair {
    Channel ours, theirs;
};

} // namespace tetrace
