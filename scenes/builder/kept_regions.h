#pragma once

#include "core/mesh/scene.h"

#include <vector>

namespace tetrace {

/// Finds the regions of optimised tets again: occlusive faces are around each, and the same as before. Puts the tets of
/// the file's regions first. Returns what Scene::source_tets is for them, without numbers (0); empty if a part between
/// faces is not of one region.
/// scene: before it was optimised, with the file's tets first.
[[nodiscard]] std::vector<SourceTet> keep_regions(const Scene& scene, TetMesh& optimised);

} // namespace tetrace
