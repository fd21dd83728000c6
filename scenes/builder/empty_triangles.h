#pragma once

#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// Keeps a mesh watertight when its triangles without area are dropped afterwards (clean_up): if b is on the edge from
/// a to c of such a triangle, every other triangle with that edge is split at b. Exact; vertices at the same place
/// count as one. origins: as many values as triangles, extended with those of the new ones. Returns how many were
/// split.
std::uint64_t split_at_empty_triangles(TriangleMesh& mesh, std::vector<std::uint32_t>& origins);

} // namespace tetrace
