#pragma once

#include "core/pack/packed_scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetrace {

// Exit searches by themselves (the paper, Table 5): random tets, and random rays through each, the same on every
// machine. All coordinates are multiples of 2^-16 and below 2^4 in magnitude: floats represent them exactly, and 64-bit
// integers decide exactly by which face a ray leaves.

/// Random tets with corners uniform in the cube [-1, 1)^3, without those flatter than 2^-20 of the unit cube, and
/// without half-faces. layout: of tets that hold their corners, as the kernels of task search need.
[[nodiscard]] PackedScene search_tets(std::uint32_t count, Layout layout);

/// Rays that each enter a tet through the inside of a known face.
struct SearchRays {
    std::vector<Quad> quads;         ///< in the form of Session::set_rays
    std::vector<std::uint8_t> exits; ///< per ray: the faces by which it leaves in exact arithmetic, a bit each; several
                                     ///< where it meets an edge

    [[nodiscard]] std::size_t count() const { return exits.size(); }
    [[nodiscard]] std::uint32_t half_face(std::size_t ray) const
    {
        return quads[ray].w;
    } ///< the tet and its entry face
};

/// The first rays_per_tet rays of each of the tets from first_tet on, tet after tet. A ray goes from a random point of
/// a random face to one of another random face, and starts up to four times their distance before the first.
/// Throws Error{internal} unless rays_per_tet is a multiple of TILE_WIDTH.
[[nodiscard]] SearchRays search_rays(std::uint32_t first_tet, std::uint32_t tets, std::uint32_t rays_per_tet);

/// How the face that was found for ray `number` compares with exact arithmetic.
enum class SearchVerdict {
    right,
    tie,   ///< another face, but the ray passes all edges that exclude it within tie_bound (docs/spec/numbers.md, N2)
    wrong, ///< another face
    lost   ///< NO_EXIT
};
[[nodiscard]] SearchVerdict judge(const SearchRays& rays, std::size_t number, std::uint32_t face);

} // namespace tetrace
