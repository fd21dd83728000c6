#pragma once

#include "core/mesh/scene.h"
#include "scenes/builder/raw_tets.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// Vertices of a tet; positive as in RawTets.
using TetCorners = std::array<std::uint32_t, 4>;

/// A face of a file's tets that rays may hit: on the hull, or between two regions.
struct TetSurface {
    std::array<std::uint32_t, 3> corners; ///< seen from outside the tet, counter-clockwise
    std::uint32_t half_face;              ///< of the first of its tets
    bool is_hull;
};

/// Drops vertices that no tet has, and those at the place of an earlier one.
void keep_corners(std::vector<Float3>& vertices, std::vector<TetCorners>& tets);

/// The surface of tets, in the order of its half-faces. Throws Error{invalid_input} naming the tets of a face that more
/// than two share, or two that are on the same side of it.
[[nodiscard]] std::vector<TetSurface> surface_of(const std::vector<TetCorners>& tets,
                                                 const std::vector<SourceTet>& numbers);

/// The tets of a file in a placed scene, whose mesh is their surface and has all of their vertices.
struct OwnTets {
    std::vector<TetCorners> tets;
    std::vector<SourceTet> numbers;
    TriangleMesh hull;                        ///< with the vertices that it needs
    std::vector<std::uint32_t> hull_vertices; ///< of each of these, that of the scene's mesh
};

/// Checks tets that are placed, and rounded to the grid. Throws Error{invalid_input} naming those that are flat or
/// inverted then, and those whose surfaces cross.
[[nodiscard]] OwnTets check_own_tets(const Scene& scene, std::vector<TetCorners> tets, std::vector<SourceTet> numbers);

/// The file's tets, in its order, and those of `filled` that are outside of them. filled: of a domain in which the hull
/// was a constraint; input points: the hull's, then the domain's. Throws BuilderFailure{BUILDER_ABSURD_OUTPUT} if the
/// hull's faces are not all in it, whole; Error{invalid_input} naming two tets that overlap.
[[nodiscard]] RawTets join_own_tets(const OwnTets& own, const Scene& scene, const RawTets& filled);

/// Throws BuilderFailure{BUILDER_ABSURD_OUTPUT} unless the scene's first tets are these, with the same vertices.
void require_own_tets(const OwnTets& own, const Scene& scene);

} // namespace tetrace
