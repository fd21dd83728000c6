#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

namespace tetrace {

/// $XDG_CACHE_HOME (an absolute path, as the XDG specification demands), else $HOME/.cache; empty if neither variable
/// has an absolute path. Drivers' libraries keep what they compile there too, PoCL and Mesa for example.
[[nodiscard]] std::filesystem::path cache_home();

/// The cache's home that CacheHome found closed; empty if it was open. What is in it can still be read.
[[nodiscard]] std::filesystem::path closed_cache_home();

/// Gives this process, and those that it starts, a temporary folder for caches if the usual one cannot be written to,
/// as in containers: PoCL has no device without one. XDG_CACHE_HOME then names it, as do POCL_CACHE_DIR and
/// MESA_SHADER_CACHE_DIR if they were set to folders that cannot be written to. Make it before any driver is loaded and
/// any thread is started. The folder is removed with it, unless keep() was called; if a signal ends this process, by
/// another that waits for its end.
class CacheHome {
public:
    CacheHome();
    ~CacheHome();
    CacheHome(const CacheHome&) = delete;
    CacheHome& operator=(const CacheHome&) = delete;

    /// Leaves the folder where it is.
    void keep();
    /// What the user should know; empty if the usual folder is used.
    [[nodiscard]] std::string note() const;

private:
    void start_remover();
    void dismiss_remover();

    std::string closed_; ///< "/root/.cache cannot be written to (Read-only file system)"; empty: all is as usual
    std::filesystem::path temporary_;
    bool runs_programs_ = true; ///< whether code in temporary_ may be loaded
    bool keeps_ = false;
    pid_t remover_ = -1; ///< removes temporary_ when this process has ended; -1: there is none
    int pipe_ = -1;      ///< to it
};

} // namespace tetrace
