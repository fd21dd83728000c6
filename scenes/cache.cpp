#include "scenes/cache.h"

#include "core/base/cache_home.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "scenes/scene_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

namespace tetrace {

namespace {

/// Whether the path still leads to the open file: its last owner may have removed it between our open and our lock.
bool still_there(const std::filesystem::path& path, int file)
{
    struct stat opened {
    }, named{};
    return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

} // namespace

FileLock::FileLock(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}

FileLock::FileLock(FileLock&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

FileLock::~FileLock()
{
    if (file_ < 0) return;
    ::unlink(path_.c_str()); // before the lock is released, so that no process locks a file that is about to vanish
    ::close(file_);
}

bool FileLock::is_held(const std::filesystem::path& path)
{
    const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return false;
    const bool held = try_lock(file) == LockAttempt::held;
    ::close(file);
    return held;
}

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& path)
{
    for (;;) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        const LockAttempt attempt = file >= 0 ? try_lock(file) : LockAttempt::failed;
        if (attempt == LockAttempt::taken) {
            FileLock lock(path, file);
            if (still_there(path, file)) return lock;
            ::close(std::exchange(lock.file_, -1));
            continue;
        }
        const int reason = errno;
        if (file >= 0) ::close(file);
        if (attempt == LockAttempt::held) return std::nullopt;
        if (reason != EINTR)
            throw Error(ErrorKind::invalid_input, fmt::format("locking {}: {}; check that its folder may be written to",
                                                              path.string(), std::strerror(reason)));
    }
}

FileLock FileLock::wait_for(const std::filesystem::path& scene_file, const std::function<void()>& tell)
{
    std::filesystem::path path = scene_file;
    path += ".lock";
    for (;;) {
        if (auto lock = try_take(path)) return std::move(*lock);
        tell();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

namespace fs = std::filesystem;

namespace {

bool all_in(std::string_view text, std::string_view accepted)
{
    return text.find_first_not_of(accepted) == std::string_view::npos;
}

constexpr std::string_view digits = "0123456789";
constexpr std::string_view label_characters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";

bool is_key(std::string_view text)
{
    return text.size() == 16 && all_in(text, "0123456789abcdef");
}

/// The process of a temporary name, `<name>.<pid>-<number>.tmp` (see temporary_name); empty for other names.
std::optional<pid_t> writer_of(std::string_view name)
{
    if (!name.ends_with(".tmp")) return std::nullopt;
    name.remove_suffix(4);
    const std::string_view suffix = name.substr(name.rfind('.') + 1); // the whole name if it lacks a dot
    const std::size_t dash = suffix.find('-');
    if (dash == 0 || dash == std::string_view::npos || dash + 1 == suffix.size()) return std::nullopt;
    if (suffix.size() == name.size() || !all_in(suffix.substr(0, dash), digits) ||
        !all_in(suffix.substr(dash + 1), digits))
        return std::nullopt;
    return static_cast<pid_t>(std::strtol(suffix.data(), nullptr, 10));
}

/// Length of `<label>-<16 digits>.tet` at the beginning of a name; 0 if it does not begin so.
std::size_t scene_name_length(std::string_view name)
{
    for (std::size_t dot = name.find(".tet"); dot != std::string_view::npos; dot = name.find(".tet", dot + 1))
        if (dot >= 18 && name[dot - 17] == '-' && is_key(name.substr(dot - 16, 16)))
            return all_in(name.substr(0, dot), label_characters) ? dot + 4 : 0;
    return 0;
}

struct OwnEntry {
    fs::path path;
    fs::path scene; ///< the scene's file that it belongs to; empty for meshes and programs
    enum class Kind { scene, lock, work, mesh, program } kind;
    std::uint64_t bytes = 0;
};

std::vector<fs::path> children(const fs::path& folder)
{
    std::error_code ignored; // no folder, no children
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
        found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

std::uint64_t bytes_of(const fs::path& path)
{
    std::error_code ignored; // it may vanish meanwhile
    if (fs::is_directory(fs::symlink_status(path, ignored))) {
        std::uint64_t sum = 0;
        for (const fs::path& child : children(path))
            sum += bytes_of(child);
        return sum;
    }
    const std::uintmax_t size = fs::file_size(path, ignored);
    return ignored ? 0 : size;
}

/// What tetrace put there, and may remove: a scene, or the lock or the work folder of its build.
std::optional<OwnEntry> scene_entry(const fs::path& path)
{
    const std::string name = path.filename().string();
    const std::size_t length = scene_name_length(name);
    const std::string rest = name.substr(length);
    OwnEntry entry{path, path.parent_path() / name.substr(0, length), OwnEntry::Kind::scene, bytes_of(path)};
    if (rest == ".lock")
        entry.kind = OwnEntry::Kind::lock;
    else if (writer_of(rest) && rest.find('.', 1) == rest.size() - 4)
        entry.kind = OwnEntry::Kind::work;
    else if (!rest.empty())
        return std::nullopt;
    return length > 0 ? std::optional(entry) : std::nullopt;
}

/// `<16 digits>.bin` of core/device/program_cache.h, or what a killed process left while it wrote that.
bool is_program(std::string_view name)
{
    if (name.size() < 20 || !is_key(name.substr(0, 16)) || name.substr(16, 4) != ".bin") return false;
    const std::string_view rest = name.substr(20);
    return rest.empty() || (writer_of(rest) && rest.find('.', 1) == rest.size() - 4);
}

std::vector<OwnEntry> own_entries(const fs::path& cache)
{
    std::vector<OwnEntry> entries;
    for (const fs::path& path : children(cache))
        if (auto entry = scene_entry(path)) entries.push_back(*entry);
    for (const fs::path& folder : children(cache / "meshes"))
        if (is_key(folder.filename().string()))
            for (const fs::path& path : children(folder))
                entries.push_back({path, {}, OwnEntry::Kind::mesh, bytes_of(path)});
    for (const fs::path& path : children(cache / "programs"))
        if (is_program(path.filename().string()))
            entries.push_back({path, {}, OwnEntry::Kind::program, bytes_of(path)});
    return entries;
}

/// Whether a process that still lives is writing that mesh or program.
bool being_written(const fs::path& path)
{
    const std::optional<pid_t> writer = writer_of(path.filename().string());
    return writer && (::kill(*writer, 0) == 0 || errno == EPERM);
}

std::uint64_t remove_all(const OwnEntry& entry)
{
    std::error_code failure;
    fs::remove_all(entry.path, failure);
    if (failure)
        throw Error(ErrorKind::invalid_input, fmt::format("clearing the cache: {} cannot be removed: {}",
                                                          entry.path.string(), failure.message()));
    return entry.bytes;
}

/// Removes one entry; returns the bytes that this freed.
std::uint64_t remove_entry(const OwnEntry& entry)
{
    if (entry.kind == OwnEntry::Kind::scene) return remove_all(entry);
    if (entry.kind == OwnEntry::Kind::mesh || entry.kind == OwnEntry::Kind::program)
        return being_written(entry.path) ? 0 : remove_all(entry);
    fs::path lock_path = entry.scene;
    const std::optional<FileLock> lock = FileLock::try_take(lock_path += ".lock");
    if (!lock) return 0;                                               // a build is going on
    return entry.kind == OwnEntry::Kind::work ? remove_all(entry) : 0; // a lock's file goes with the lock just taken
}

/// A label as a part of a file's name.
std::string safe_name(std::string label)
{
    for (char& c : label)
        if (label_characters.find(c) == std::string_view::npos) c = '_';
    return label.empty() ? "scene" : label.substr(0, 100);
}

} // namespace

fs::path cache_directory()
{
    if (const fs::path home = cache_home(); !home.empty()) return home / "tetrace";
    throw Error(ErrorKind::missing,
                "looking for the cache: neither XDG_CACHE_HOME nor HOME names a folder by an absolute "
                "path; set XDG_CACHE_HOME to a folder where scenes may be kept");
}

void make_cache_folder(const fs::path& folder)
{
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure)
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("making the cache's folder {}: {}; set XDG_CACHE_HOME to a folder that may be written to",
                        folder.string(), failure.message()));
}

fs::path cached_scene_path(const std::string& label, std::uint64_t mesh_hash, const BuildOptions& options)
{
    std::string key = fmt::format("version {} mesh {} domain {} divisions {} switches {} tets {}", scene_file_version,
                                  hash_text(mesh_hash), name_of(options.domain), options.divisions, options.switches,
                                  name_of(options.tets));
    if (!options.repair) key += " not repaired";
    if (options.tets == TetsKind::rays)
        key += fmt::format(" effort {} optimiser {}{}", options.effort, optimiser_version,
                           options.optimise_own ? " of all tets" : "");
    return path_to_read(fmt::format("{}-{}.tet", safe_name(label), hash_text(hash_of(key))));
}

fs::path path_to_read(const std::string& name)
{
    std::error_code ignored; // then there is none
    if (const fs::path home = closed_cache_home(); !home.empty() && fs::exists(home / "tetrace" / name, ignored))
        return home / "tetrace" / name;
    return cache_directory() / name;
}

fs::path cached_mesh_path(const std::string& name, std::uint64_t key)
{
    const fs::path folder = cache_directory() / "meshes" / hash_text(key);
    make_cache_folder(folder);
    return folder / name;
}

BuildFolder::BuildFolder(const fs::path& scene_file) : path_(temporary_name(scene_file))
{
    make_cache_folder(path_);
}

BuildFolder::~BuildFolder()
{
    std::error_code ignored; // what cannot be removed is listed and cleared with the cache
    fs::remove_all(path_, ignored);
}

std::vector<CachedFile> list_cache()
{
    std::vector<CachedFile> files;
    for (const OwnEntry& entry : own_entries(cache_directory()))
        if (entry.kind != OwnEntry::Kind::lock) files.push_back({entry.path, entry.bytes});
    return files;
}

void clear_leftovers(const fs::path& scene_file)
{
    for (const fs::path& path : children(scene_file.parent_path())) {
        const auto entry = scene_entry(path);
        std::error_code ignored; // what cannot be removed is listed and cleared with the cache
        if (entry && entry->kind == OwnEntry::Kind::work && entry->scene == scene_file) fs::remove_all(path, ignored);
    }
}

std::uint64_t clear_cache()
{
    const fs::path cache = cache_directory();
    std::uint64_t freed = 0;
    for (const OwnEntry& entry : own_entries(cache))
        freed += remove_entry(entry);
    std::error_code not_empty; // not ours, so it stays
    for (const fs::path& folder : children(cache / "meshes"))
        if (is_key(folder.filename().string())) fs::remove(folder, not_empty);
    fs::remove(cache / "meshes", not_empty);
    fs::remove(cache / "programs", not_empty);
    fs::remove(cache, not_empty);
    return freed;
}

} // namespace tetrace
