#pragma once

#include "scenes/catalogue.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A lock that one process, and one of its threads, holds at a time. The system releases it when the process ends. The
/// lock's file is removed with the lock.
class FileLock {
public:
    /// Empty where another process or thread has it. Throws Error{invalid_input} naming the path and the system's
    /// reason.
    [[nodiscard]] static std::optional<FileLock> try_take(const std::filesystem::path& path);

    /// Takes the lock of a scene's file, as soon as no other has it. tell: called while it waits.
    [[nodiscard]] static FileLock wait_for(const std::filesystem::path& scene_file, const std::function<void()>& tell);

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

/// The folder tetrace of cache_home(); made when first written to. Throws Error{missing} if there is none.
[[nodiscard]] std::filesystem::path cache_directory();

/// Where the file of this name is read from: closed_cache_home(), if that has it, else the folder above.
[[nodiscard]] std::filesystem::path path_to_read(const std::string& name);

/// A part of the key of tets for rays: raised where the optimiser makes others of the same mesh.
inline constexpr std::uint32_t optimiser_version = 4;

/// The file of the scene that is built from a mesh with these options: `<label>-<16 digits>.tet`. The digits are a hash
/// of the mesh's bytes (mesh_hash), of the options that decide the tets, of scene_file_version, and of
/// optimiser_version for tets for rays. As path_to_read() has it.
[[nodiscard]] std::filesystem::path cached_scene_path(const std::string& label, std::uint64_t mesh_hash,
                                                      const BuildOptions& options);

/// The file of a mesh that tetrace made or unpacked: `meshes/<16 digits>/<name>`. Makes the folder.
[[nodiscard]] std::filesystem::path cached_mesh_path(const std::string& name, std::uint64_t key);

/// Makes the cache's folder, or one in it. Throws Error{invalid_input} naming it and the system's reason.
void make_cache_folder(const std::filesystem::path& folder);

/// A folder that only one build of a scene uses, next to the scene's file; it is removed however the build ends.
class BuildFolder {
public:
    /// Throws as make_cache_folder() does.
    explicit BuildFolder(const std::filesystem::path& scene_file);
    ~BuildFolder();
    BuildFolder(const BuildFolder&) = delete;
    BuildFolder& operator=(const BuildFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

struct CachedFile {
    std::filesystem::path path;
    std::uint64_t bytes = 0;
};
/// Scenes, meshes, compiled programs and leftovers of killed processes; sorted by path within each.
[[nodiscard]] std::vector<CachedFile> list_cache();

/// Removes leftovers of killed builds of a scene. The caller holds the lock of the scene's file, so no other build of
/// it is going on.
void clear_leftovers(const std::filesystem::path& scene_file);

/// Removes what tetrace put there, and nothing else; returns how many bytes that freed. Keeps what another process is
/// building.
std::uint64_t clear_cache();

} // namespace tetrace
