#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace tetrace {

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

} // namespace tetrace
