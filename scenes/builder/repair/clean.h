#pragma once

#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// What clean_up() took away.
struct CleanUp {
    std::uint64_t merged_vertices = 0;      ///< vertices at exactly the place of an earlier one
    std::uint64_t unused_vertices = 0;      ///< vertices of no remaining triangle
    std::uint64_t degenerate_triangles = 0; ///< a repeated vertex, or collinear vertices in exact arithmetic
    std::uint64_t duplicate_triangles = 0;  ///< the same three vertices, in any order, as an earlier triangle

    friend bool operator==(const CleanUp&, const CleanUp&) = default;
};

/// Merges vertices that are equal bit for bit (-0 counts as 0), then removes degenerate and duplicate triangles and
/// unused vertices. The order of what remains is kept. Coordinates are finite; indices are in range.
/// origins: as many values as triangles; those of removed triangles go too.
CleanUp clean_up(TriangleMesh& mesh, std::vector<std::uint32_t>& origins);
CleanUp clean_up(TriangleMesh& mesh);

} // namespace tetrace
