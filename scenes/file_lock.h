#pragma once

#include <filesystem>
#include <optional>

namespace tetrace {

/// Exclusive among processes (and threads) as long as it lives; the system ends it with its process. The lock's file is
/// removed with the lock.
class FileLock {
public:
    /// Empty where somebody else has it. Throws Error{invalid_input} naming the path and the system's reason.
    [[nodiscard]] static std::optional<FileLock> try_take(const std::filesystem::path& path);

    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&&) = delete;
    ~FileLock();

private:
    FileLock(std::filesystem::path path, int file);

    std::filesystem::path path_;
    int file_;
};

} // namespace tetrace
