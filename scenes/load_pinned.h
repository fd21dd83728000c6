#pragma once

#include "scenes/load.h"
#include "scenes/pinned.h"

#include <functional>

namespace tetrace {

/// Loads a pinned scene. If this version's optimiser made it, the scene is built here, or taken from the cache, as any
/// other scene is. If that gives other tets (another TetGen) or fails, or if the optimiser is a newer one, its stored
/// tets are joined with the mesh, and LoadedScene::messages say so. In all these cases the scene has the pinned hash.
/// If the mesh file of the catalogue's row is another one, and nobody named the scene, that mesh is loaded, and a
/// message says so; an interrupted build is returned as it is. request: its name is the pinned one's. build: loads the
/// scene of a mesh file, with the request's options. Throws Error{usage} if the request has build options of its own,
/// Error{invalid_input} for another mesh file of a scene that was named, and as load_scene() does.
[[nodiscard]] LoadedScene load_pinned(const PinnedScene& pinned, const SceneRequest& request, const Progress& progress,
                                      const std::function<LoadedScene(const std::filesystem::path& mesh)>& build);

} // namespace tetrace
