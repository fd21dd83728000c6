#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

namespace tetrace::fuzz {

/// A regular file without a disk, for readers that want a path.
class MemoryFile {
public:
    explicit MemoryFile(std::string_view bytes) : file_(::memfd_create("fuzz", MFD_CLOEXEC))
    {
        for (std::size_t done = 0; file_ >= 0 && done < bytes.size();) {
            const ssize_t written = ::write(file_, bytes.data() + done, bytes.size() - done);
            if (written < 0) throw std::runtime_error("a file in memory cannot be written");
            done += static_cast<std::size_t>(written);
        }
    }
    ~MemoryFile() { ::close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(file_); }

private:
    int file_;
};

/// Runs a reader; that it refuses its input is right.
template <class Reader>
void may_refuse(const Reader& reader)
{
    try {
        reader();
    } catch (const Error& refused) {
        if (refused.kind() == ErrorKind::internal) throw; // the input is to blame, not the program
    }
}

} // namespace tetrace::fuzz
