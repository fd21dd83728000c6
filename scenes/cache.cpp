#include "scenes/cache.h"

#include "core/error.h"
#include "core/hash.h"
#include "scenes/file_lock.h"
#include "scenes/scene_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <regex>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

// What we put there, and so may remove. The lock and the work folder of a build carry the scene's name in front.
const std::regex& scene_pattern()
{
    static const std::regex pattern(R"(([A-Za-z0-9._-]+-[0-9a-f]{16}\.tet)(\.lock|\.[0-9]+-[0-9]+\.tmp)?)");
    return pattern;
}
const std::regex& mesh_folder_pattern()
{
    static const std::regex pattern("[0-9a-f]{16}");
    return pattern;
}
const std::regex& temporary_pattern()
{
    static const std::regex pattern(R"(.*\.([0-9]+)-[0-9]+\.tmp)");
    return pattern;
}

struct OwnEntry {
    fs::path path;
    fs::path scene; ///< the scene's file that it belongs to; empty for meshes
    enum class Kind { scene, lock, work, mesh } kind;
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
    std::error_code ignored; // it may vanish while we look
    if (fs::is_directory(fs::symlink_status(path, ignored))) {
        std::uint64_t sum = 0;
        for (const fs::path& child : children(path))
            sum += bytes_of(child);
        return sum;
    }
    const std::uintmax_t size = fs::file_size(path, ignored);
    return ignored ? 0 : size;
}

std::optional<OwnEntry> scene_entry(const fs::path& path)
{
    std::smatch parts;
    const std::string name = path.filename().string();
    if (!std::regex_match(name, parts, scene_pattern())) return std::nullopt;
    const std::string rest = parts[2].str();
    const auto kind = rest.empty()      ? OwnEntry::Kind::scene
                      : rest == ".lock" ? OwnEntry::Kind::lock
                                        : OwnEntry::Kind::work;
    return OwnEntry{path, path.parent_path() / parts[1].str(), kind, bytes_of(path)};
}

std::vector<OwnEntry> own_entries(const fs::path& cache)
{
    std::vector<OwnEntry> entries;
    for (const fs::path& path : children(cache))
        if (auto entry = scene_entry(path)) entries.push_back(*entry);
    for (const fs::path& folder : children(cache / "meshes"))
        if (std::regex_match(folder.filename().string(), mesh_folder_pattern()))
            for (const fs::path& path : children(folder))
                entries.push_back({path, {}, OwnEntry::Kind::mesh, bytes_of(path)});
    return entries;
}

/// Whether a process that still lives is writing that mesh.
bool being_written(const fs::path& path)
{
    std::smatch parts;
    const std::string name = path.filename().string();
    if (!std::regex_match(name, parts, temporary_pattern())) return false;
    const long pid = std::strtol(parts[1].str().c_str(), nullptr, 10);
    return ::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM;
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
    if (entry.kind == OwnEntry::Kind::mesh) return being_written(entry.path) ? 0 : remove_all(entry);
    fs::path lock_path = entry.scene;
    const std::optional<FileLock> lock = FileLock::try_take(lock_path += ".lock");
    if (!lock) return 0;                                               // a build is going on
    return entry.kind == OwnEntry::Kind::work ? remove_all(entry) : 0; // a lock's file goes with the lock just taken
}

/// A label as a part of a file's name.
std::string safe_name(std::string label)
{
    for (char& c : label)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_' && c != '-') c = '_';
    return label.empty() ? "scene" : label.substr(0, 100);
}

fs::path absolute_from_environment(const char* variable)
{
    const char* value = std::getenv(variable);
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();
}

} // namespace

fs::path cache_directory()
{
    if (const fs::path given = absolute_from_environment("XDG_CACHE_HOME"); !given.empty()) return given / "tetrace";
    if (const fs::path home = absolute_from_environment("HOME"); !home.empty()) return home / ".cache" / "tetrace";
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
    const std::string domain = options.domain == DomainKind::tight ? "tight" : "wide";
    const std::string key = fmt::format("version {} mesh {} domain {} divisions {} switches {}", scene_file_version,
                                        hash_text(mesh_hash), domain, options.divisions, options.switches);
    return cache_directory() / fmt::format("{}-{}.tet", safe_name(label), hash_text(hash_of(key)));
}

fs::path cached_mesh_path(const std::string& name, std::uint64_t key)
{
    const fs::path folder = cache_directory() / "meshes" / hash_text(key);
    make_cache_folder(folder);
    return folder / name;
}

std::vector<CachedFile> list_cache()
{
    std::vector<CachedFile> files;
    for (const OwnEntry& entry : own_entries(cache_directory()))
        if (entry.kind != OwnEntry::Kind::lock) files.push_back({entry.path, entry.bytes});
    return files;
}

std::uint64_t clear_cache()
{
    const fs::path cache = cache_directory();
    std::uint64_t freed = 0;
    for (const OwnEntry& entry : own_entries(cache))
        freed += remove_entry(entry);
    std::error_code not_empty; // then somebody else put something there, and it stays
    for (const fs::path& folder : children(cache / "meshes"))
        if (std::regex_match(folder.filename().string(), mesh_folder_pattern())) fs::remove(folder, not_empty);
    fs::remove(cache / "meshes", not_empty);
    fs::remove(cache, not_empty);
    return freed;
}

} // namespace tetrace
