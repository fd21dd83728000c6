#include "core/base/file_bytes.h"

#include "core/base/descriptor.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace tetrace {

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

} // namespace tetrace
