#pragma once

#include "core/mesh/scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tetrace {

/// What is needed to make a scene's tets again if its mesh is available: the vertices that the mesh does not have, and
/// four vertices per tet, compressed by xz. Coordinates of the mesh are not in it.
/// Throws Error{unsupported} for tets that cannot be made again from this: their first vertices are not the mesh's, or
/// an occlusive face is only a part of a triangle.
[[nodiscard]] std::vector<std::byte> store_tets(const Scene& scene);

/// The scene `placed`, which needs no tets, with the stored ones instead. Checks only what memory safety needs: the
/// caller compares scene_hash(). Throws Error{invalid_input} if the bytes are damaged, or are of another mesh.
[[nodiscard]] Scene with_stored_tets(const Scene& placed, std::span<const std::byte> stored);

} // namespace tetrace
