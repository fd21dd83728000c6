#pragma once

#include "core/base/descriptor.h"

#include <cstddef>
#include <span>

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

} // namespace tetrace
