#include "core/base/cache_home.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

fs::path absolute_from_environment(const char* variable)
{
    const char* value = std::getenv(variable);
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();
}

bool is_folder(const fs::path& path)
{
    std::error_code ignored; // what cannot be looked at is of no use
    return fs::is_directory(path, ignored);
}

/// Why no file can be made in a folder, which need not exist yet; empty if one can.
std::string why_closed(fs::path folder)
{
    for (;;) {
        if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0)
            return is_folder(folder) ? "" : std::strerror(ENOTDIR);
        const int reason = errno;
        if (reason != ENOENT || !folder.has_relative_path()) return std::strerror(reason);
        folder = folder.parent_path();
    }
}

bool runs_programs(const fs::path& folder)
{
    struct statvfs facts {};
    return ::statvfs(folder.c_str(), &facts) == 0 && (facts.f_flag & ST_NOEXEC) == 0;
}

/// A new folder in the first of these that code may be loaded from, else in the first that takes one. Empty: in none.
fs::path make_temporary()
{
    std::vector<fs::path> parents = {absolute_from_environment("TMPDIR"), "/tmp", "/var/tmp", "/dev/shm"};
    std::erase_if(parents, [](const fs::path& parent) { return parent.empty() || !is_folder(parent); });
    std::ranges::stable_partition(parents, runs_programs);
    for (const fs::path& parent : parents) {
        std::string name = parent / "tetrace-cache-XXXXXX";
        if (::mkdtemp(name.data()) != nullptr) return name;
    }
    return {};
}

/// Closes all files but the standard input. Kernels before 5.9, and filters of system calls, lack the call for many.
void keep_only_input()
{
    if (::close_range(STDIN_FILENO + 1, ~0u, 0) == 0) return;
    constexpr int most = 65536; // a limit may be none
    const long limit = ::sysconf(_SC_OPEN_MAX);
    const int end = limit < 0 || limit > most ? most : static_cast<int>(limit);
    for (int file = STDIN_FILENO + 1; file < end; ++file)
        ::close(file);
}

/// In a process of its own, to which no signal of a terminal comes: waits until the other end of the pipe is closed,
/// and removes the folder unless something was written to it first. It holds no stream: a reader of this program's
/// output does not wait for it.
[[noreturn]] void wait_and_remove(const fs::path& folder, int pipe)
{
    ::setsid();
    ::dup2(pipe, STDIN_FILENO);
    keep_only_input();
    char word = 0;
    ssize_t got = 0;
    do
        got = ::read(STDIN_FILENO, &word, 1);
    while (got < 0 && errno == EINTR);
    std::error_code ignored; // nothing depends on it
    if (got == 0) fs::remove_all(folder, ignored);
    ::_exit(0);
}

fs::path& closed_home()
{
    static fs::path home;
    return home;
}

} // namespace

fs::path cache_home()
{
    if (fs::path given = absolute_from_environment("XDG_CACHE_HOME"); !given.empty()) return given;
    const fs::path home = absolute_from_environment("HOME");
    return home.empty() ? home : home / ".cache";
}

fs::path closed_cache_home()
{
    return closed_home();
}

CacheHome::CacheHome()
{
    const fs::path home = cache_home();
    const std::string reason = home.empty() ? "neither XDG_CACHE_HOME nor HOME is an absolute path" : why_closed(home);
    if (!reason.empty()) closed_ = home.empty() ? reason : home.string() + " cannot be written to (" + reason + ")";
    std::vector<const char*> closed;
    if (!reason.empty()) closed.push_back("XDG_CACHE_HOME");
    for (const char* const variable : {"POCL_CACHE_DIR", "MESA_SHADER_CACHE_DIR"}) {
        const char* const folder = std::getenv(variable);
        if (folder == nullptr || *folder == 0) continue;
        std::error_code ignored; // there is no working directory: the path is as it was
        const fs::path whole = fs::absolute(folder, ignored);
        const std::string why = why_closed(whole.empty() ? fs::path(folder) : whole);
        if (why.empty()) continue;
        closed.push_back(variable);
        if (closed_.empty()) closed_ = std::string(folder) + " cannot be written to (" + why + ")";
    }
    if (closed.empty()) return;
    temporary_ = make_temporary();
    if (temporary_.empty()) return;
    start_remover();
    if (!reason.empty()) closed_home() = home;
    runs_programs_ = runs_programs(temporary_);
    for (const char* const variable : closed)
        ::setenv(variable, temporary_.c_str(), 1);
}

CacheHome::~CacheHome()
{
    dismiss_remover();
    std::error_code ignored; // nothing depends on it
    if (remover_ < 0 && !temporary_.empty() && !keeps_) fs::remove_all(temporary_, ignored);
}

void CacheHome::keep()
{
    keeps_ = true;
    if (remover_ > 0) static_cast<void>(!::write(pipe_, "k", 1));
    dismiss_remover();
}

void CacheHome::start_remover()
{
    int ends[2] = {};
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    remover_ = ::fork();
    if (remover_ == 0) {
        ::close(ends[1]); // else it would wait for itself
        wait_and_remove(temporary_, ends[0]);
    }
    ::close(ends[0]);
    pipe_ = ends[1];
}

void CacheHome::dismiss_remover()
{
    if (pipe_ < 0) return;
    ::close(pipe_);
    pipe_ = -1;
    // One that was killed removed nothing; a process that was forked from this one has none.
    if (remover_ > 0 && ::waitpid(remover_, nullptr, 0) == remover_) remover_ = -1;
}

std::string CacheHome::note() const
{
    if (closed_.empty()) return {};
    if (temporary_.empty())
        return closed_ + ", nor can a temporary folder: scenes cannot be built, and OpenCL on a processor cannot "
                         "compile; set XDG_CACHE_HOME or TMPDIR to a folder that can be written to";
    return closed_ + ": built scenes and compiled kernels are in " + temporary_.string() +
           (keeps_ ? ", which is kept; set XDG_CACHE_HOME to it to find them again"
                   : " until this run ends; set XDG_CACHE_HOME to a folder that can be written to") +
           (runs_programs_ ? ""
                           : ". Programs may not be run from there (noexec), which PoCL needs: set TMPDIR to a "
                             "folder from which they may");
}

} // namespace tetrace
