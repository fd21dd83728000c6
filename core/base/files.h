#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace tetrace {

/// Owns a file descriptor, or none.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept
    {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() { close(); }

    [[nodiscard]] int get() const { return number_; }
    [[nodiscard]] bool open() const { return number_ >= 0; }
    void close()
    {
        if (open()) ::close(std::exchange(number_, -1));
    }

private:
    int number_;
};

/// A file that appears whole or not at all: it is written under a temporary name in the same folder, synced, then
/// renamed; it has the permissions of the file that it replaces. Without commit() the temporary file is removed. Every
/// call throws Error{invalid_input} naming the path and the system's reason.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::byte> bytes);
    void commit();

private:
    [[noreturn]] void fail(const char* doing) const;

    std::filesystem::path path_, temporary_;
    int file_ = -1;
};

/// A name in the folder of `path` that no other process or thread uses now: `<name>.<pid>-<number>.tmp`.
[[nodiscard]] std::filesystem::path temporary_name(const std::filesystem::path& path);

// Files that a user names. Each appears whole or not at all, as an AtomicFile does, and keeps the permissions of the
// file that it replaces. A link stays one: what it leads to is replaced. Written in place, and checked just the same:
// devices and pipes, and files whose folder takes no new file.

/// Writes a file. Throws Error{invalid_input} naming the path and the system's reason where not every byte is written.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

/// Throws what write_whole() would throw at once; leaves no file, and changes nothing.
void require_writable(const std::filesystem::path& path);

/// The bytes of a file, or the first `most` of a longer one. Empty if it cannot be opened, or not be read so far: a
/// folder, a disk with errors, a process of /proc that ends meanwhile. (An istreambuf_iterator throws there.)
[[nodiscard]] std::optional<std::string> file_bytes(const std::filesystem::path& path,
                                                    std::size_t most = std::numeric_limits<std::size_t>::max());

/// The same of a whole file that must be there. Throws Error{missing} naming the path.
[[nodiscard]] std::string required_bytes(const std::filesystem::path& path);

/// How an attempt to lock a file ended; failed: errno says why.
enum class LockAttempt { taken, held, failed };

/// Locks a whole open file against every other opening of it, on this machine and on others that share its folder; does
/// not wait. The system releases the lock when the file is closed, and so when the process ends.
/// A record lock of the open file (fcntl, F_OFD_SETLK), which NFS, Lustre and GPFS pass on to their servers; flock
/// where the file system has none.
[[nodiscard]] LockAttempt try_lock(int file);

} // namespace tetrace
