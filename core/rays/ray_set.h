#pragma once

#include "core/mesh/scene.h"
#include "core/pack/kernel_id.h"
#include "core/rays/camera.h"
#include "core/rays/hit.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// Hit::face_id if only the existence of a hit is known, for rays for which any hit will do: Embree's.
inline constexpr std::uint32_t SOME_HIT = 0xFFFFFFFCu;

/// A ray that is given to a device instead of being made there from a pixel.
struct GivenRay {
    Float3 origin;           ///< coordinates on the 2^-40 grid
    Float3 direction;        ///< components 0 or at least 2^-20 in magnitude, as in kernels/ray.h
    float end;               ///< ray parameter of its end, NO_END if it has none
    std::uint32_t half_face; ///< tet << 2 | face that it starts on or enters by, numbered as in the scene; NO_HALF_FACE
                             ///< from outside the domain, and in a scene without tets
    std::uint32_t triangle;  ///< input triangle that it starts on, or FREE_FACE
    std::uint32_t pixel;     ///< y * width + x that it was made for

    friend bool operator==(const GivenRay&, const GivenRay&) = default;
};
static_assert(sizeof(GivenRay) == 40, "ray_hash() reads its bytes");

/// The rays of one kind for one image, the same bits on every machine and for every structure and layout.
struct RaySet {
    RayKind kind = RayKind::primary;
    RayOrder order = RayOrder::tiles;
    bool any_hit = false;    ///< any triangle before the end is an answer, not only the nearest: shadow and ao
    std::uint32_t view = 0;  ///< number of the view that it was made for
    std::uint32_t width = 0; ///< of the image
    /// A multiple of TILE_WIDTH: the last ray is repeated up to seven times as padding. Empty if no pixel makes a ray.
    std::vector<GivenRay> rays;
};

/// What rays are made from: a view of a scene and the reference's answers to its primary rays.
struct RaySource {
    const Scene& scene;
    std::uint32_t view_number;
    View view; ///< its origin as find_start() has moved it
    std::uint32_t width, height;
    std::uint32_t start_tet; ///< that holds the origin, numbered as in the scene; NO_TET: outside the domain
    /// Answers of openmp cdt/maria in math mode exact, row after row, or of bvh2 if the scene has no tets; primary and
    /// random rays need none.
    std::span<const Hit> hits;
    std::span<const std::uint32_t> mesh_of_packed; ///< the scene's number of each tet of `hits`
};

/// Position in the scene of each packed tet.
/// packed_of_mesh: PackedScene::packed_of_mesh, a permutation.
[[nodiscard]] std::vector<std::uint32_t> inverse_of(std::span<const std::uint32_t> packed_of_mesh);

/// Makes the rays of a kind, in the order of the tiles of 8 x 8 pixels that they are made for, row after row
/// (docs/spec/given-rays.md, G1):
/// - primary: the view's own, one per pixel;
/// - shadow: one per hit, to light_of() at parameter 1, if that is on the viewer's side of the surface;
/// - ao: one per hit, cosine-distributed on the viewer's side, which ends at ao_reach();
/// - diffuse: the same without an end;
/// - random: one per pixel, isotropic uniform lines that meet the domain, from outside it.
/// Throws Error{internal} if hits are not of this image or scene.
[[nodiscard]] RaySet make_rays(RayKind kind, const RaySource& source);

/// The point light of a view, near a corner of the domain: on the camera's side along the two axes on which it is
/// farthest from the domain's centre, on the other side along the third, so that most visible surfaces are lit, but not
/// from the camera's own direction. It is 1/128 of the way from the corner to the centre: inside the domain, and in a
/// tight domain outside the mesh's bounding box.
[[nodiscard]] Float3 light_of(const Domain& domain, Float3 camera);

/// How far rays of kind ao reach: a quarter of the radius of the mesh's bounding sphere.
[[nodiscard]] double ao_reach(const TriangleMesh& mesh);

/// 64-bit hash of everything that a set asks for: its rays in their order, and whether any hit is an answer.
[[nodiscard]] std::uint64_t ray_hash(const RaySet& set);

} // namespace tetrace
