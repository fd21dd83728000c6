#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/mesh/scene.h"
#include "scenes/catalogue.h"

#include <optional>

namespace tetrace {

struct LoadedScene {
    Scene scene;
    std::uint64_t hash = 0; ///< scene_hash(scene)
    bool from_cache = false;
    bool interrupted = false;     ///< Ctrl-C came while it was built (BuildOptions::keep_unfinished)
    std::filesystem::path file;   ///< the `.tet` file; empty for `cubes`, `lattice` and without tets
    std::optional<Error> no_tets; ///< why the scene is without tets, and is not cached (BuildOptions::mesh_will_do)
    std::vector<Aim> views;       ///< CatalogueEntry::views
    std::vector<std::string>
        messages; ///< for the user: a damaged cache file rebuilt, triangles dropped, options not used
};

/// Finds a scene in the cache, or builds it with tetrace-builder and caches it. `cubes` and `lattice` are made in
/// place. A scene whose optimiser was stopped early, by its time limit or by Ctrl-C, is stored next to it under a name
/// of its own, and never taken for the whole one. Throws Error{usage} for a name that is neither in the catalogue nor a
/// path (lists the accepted ones) and for switches that the builder does not accept, Error{missing} for a file or a
/// mesh that is not available here, Error{invalid_input} with the builder's finding, Error{interrupted} after Ctrl-C
/// (the builder is ended too). With BuildOptions::mesh_will_do, triangles that cross and TetGen's failures are not
/// thrown but returned, with a scene without tets.
[[nodiscard]] LoadedScene load_scene(const SceneRequest& request, const Progress& progress);

/// A mesh as its file has it.
struct ReadMesh {
    TriangleMesh mesh;                 ///< every number as it is read; `cubes` and `lattice` as they are made
    std::filesystem::path file;        ///< empty if there is none
    std::vector<std::string> messages; ///< for the user
};

/// Reads a mesh with tetrace-builder, without building a scene. name: as SceneRequest::name, but neither a `.tet` file
/// nor a pinned scene, whose meshes have been cleaned and placed. Throws as load_scene() does.
[[nodiscard]] ReadMesh read_mesh_of(const std::string& name, const Progress& progress);

} // namespace tetrace
