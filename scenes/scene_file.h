#pragma once

#include "core/mesh/scene.h"

#include <filesystem>

namespace tetrace {

/// Version of the `.tet` format and of the code that builds its content; part of the cache's key.
inline constexpr std::uint32_t scene_file_version = 6;

/// Writes a scene to a temporary name next to `path`, syncs, and renames it: a reader sees the old file or the new one.
/// Throws Error{invalid_input} naming the path and the system's reason.
void write_scene(const std::filesystem::path& path, const Scene& scene);

/// Whether a file holds tets; without them (the builder's --mesh-only) only BVHs can be made of the scene.
enum class SceneFileKind { whole, mesh_only };

/// Reads a scene and checks everything: magic, version, sizes, checksum of each section, scene hash, find_defect,
/// find_gap, the entry grid, find_weak_side; no section may be empty except that of origins, and the tets of mesh_only
/// are. Throws Error{missing} if the file is missing, else Error{invalid_input} naming file, section and reason.
/// Never returns a scene that differs from the one written.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path, SceneFileKind kind = SceneFileKind::whole);

} // namespace tetrace
