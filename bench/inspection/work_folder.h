#pragma once

#include <filesystem>

namespace tetrace {

/// A new folder for what compilers read and write; gone with its contents when this is.
class WorkFolder {
public:
    /// Throws Error{invalid_input} if the system's folder for temporary files cannot hold one.
    WorkFolder();
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace tetrace
