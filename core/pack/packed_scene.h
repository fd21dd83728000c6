#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/scene.h"
#include "core/pack/kernel_id.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tetrace {

/// 16 bytes as they lie in a device's buffer; floats are stored by their bits.
struct Quad {
    std::uint32_t x, y, z, w;

    friend bool operator==(const Quad&, const Quad&) = default;
};
static_assert(sizeof(Quad) == 16, "quads are uvec4 / uint4 on a device");

/// The tet that rays start in, for layouts whose tets do not store their vertices.
struct StartTet {
    std::array<std::uint32_t, 4> vertices{}; ///< with their packed numbers
    std::uint32_t neighbour = 0;             ///< PackedScene::last_neighbours

    friend bool operator==(const StartTet&, const StartTet&) = default;
};

/// A scene in the form that is copied to a device: the tets of a CDT, or a BVH; the arrays of the other are empty.
struct PackedScene {
    Layout layout = Layout::tet80;
    std::uint32_t tet_count = 0;
    std::uint32_t divisions = 1;
    std::uint32_t stack_entries = 0; ///< of a BVH: a ray touches no more; 0: as many as kernels have

    std::vector<Quad> tets;           ///< TET80_QUADS or TET96_QUADS a tet; for each of its faces HALF32_QUADS, or one
    std::vector<Quad> triangles;      ///< TRIANGLE_QUADS an input triangle, or of tet64 an occlusive face
    std::vector<std::uint32_t> lines; ///< 3 (divisions + 1) float bits: the domain's lines, axis after axis
    std::vector<std::uint32_t> entry_ranges;     ///< EntryGrid::ranges
    std::vector<std::uint32_t> entry_half_faces; ///< EntryGrid::half_faces, in packed order

    std::vector<Quad> vertices;    ///< of tet20 and tet16: their positions (kernels/layouts/layout.h)
    std::vector<Quad> entry_faces; ///< of tet20 and tet16, in place of entry_half_faces: three vertices and a tet
    std::vector<std::uint32_t> occlusive_faces; ///< of tet20 and tet16: OCCLUSIVE_WORDS per face

    std::vector<Quad> nodes;          ///< of a BVH: BVH2_, BVH4_ or CWBVH_NODE_QUADS a node, the root first
    std::vector<Quad> leaf_triangles; ///< LEAF_TRIANGLE_QUADS a reference of a leaf to a triangle

    std::vector<std::uint32_t> packed_of_mesh;   ///< stays on the host: position of each tet of the scene in `tets`
    std::vector<std::uint32_t> number_of_vertex; ///< of tet20 and tet16, stays too: by vertex of the scene's tets
    std::vector<std::uint32_t> last_neighbours;  ///< stays too: what is across the face opposite each tet's last vertex
    std::string fall_back; ///< stays too: why a BVH's nodes are not the cheapest of its tree; empty if they are

    [[nodiscard]] std::size_t bytes() const; ///< of all arrays that are copied to a device
};

/// The domain's box and its squares along a side, which kernels get in addition to the arrays.
struct PackedDomain {
    std::uint32_t divisions = 1;
    Float3 low, high;
};

/// Of packed tets; the box of a BVH is all zero.
[[nodiscard]] PackedDomain domain_of(const PackedScene& scene);

/// Packs a scene's tets.
/// scene: valid (see find_defect), with at most as many tets as the layout's traits allow (LayoutTraits). layout: of
/// tets. Throws Error{unsupported} naming both numbers where the scene has more.
[[nodiscard]] PackedScene pack(const Scene& scene, Layout layout, TetOrder order);

} // namespace tetrace
