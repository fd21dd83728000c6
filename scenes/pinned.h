#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tetrace {

/// A scene of the catalogue as it was made once: the same mesh and the same tets in every version of tetrace, so that
/// results stay comparable when the optimiser, or TetGen, makes other tets. Its name, `bunny-1`, is a name that --scene
/// accepts; its rows are called by the catalogue's, `bunny`.
struct PinnedScene {
    std::string_view name, of;  ///< "bunny-1"; the catalogue's row, "bunny"
    std::uint64_t source_hash;  ///< of the mesh file's bytes
    std::uint64_t mesh_hash;    ///< mesh_hash() of its triangles
    std::uint64_t scene_hash;   ///< scene_hash(): mesh, tets and domain
    std::uint64_t cameras_hash; ///< hash_of_cameras() of the camera set `frame`
    std::uint32_t optimiser;    ///< the last optimiser_version that makes its tets
    std::string_view tool;      ///< that made them, as BuildInfo::tool
    double cost_before, cost_after;
    std::span<const std::byte> tets; ///< see scenes/stored_tets.h
};

/// All of them; of several versions of a scene, the newest is last.
[[nodiscard]] std::span<const PinnedScene> pinned_scenes();
/// The pinned scene of that name; null for another name.
[[nodiscard]] const PinnedScene* find_pinned(std::string_view name);
/// The pinned scene that has this scene_hash(), however it was made; null if there is none.
[[nodiscard]] const PinnedScene* pinned_with(std::uint64_t scene_hash);

} // namespace tetrace
