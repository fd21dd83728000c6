#pragma once

#include <filesystem>
#include <optional>

namespace tetrace {

/// A lock that one process, and one of its threads, holds at a time. The system releases it when the process ends. The
/// lock's file is removed with the lock.
class FileLock {
public:
    /// Empty where another process or thread has it. Throws Error{invalid_input} naming the path and the system's
    /// reason.
    [[nodiscard]] static std::optional<FileLock> try_take(const std::filesystem::path& path);

    /// Whether another process, or a FileLock of this one, has it now.
    [[nodiscard]] static bool is_held(const std::filesystem::path& path);

    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&&) = delete;
    ~FileLock();

private:
    FileLock(std::filesystem::path path, int file);

    std::filesystem::path path_;
    int file_;
};

} // namespace tetrace
