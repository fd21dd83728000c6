#pragma once

#include "core/bvh/bvh.h"
#include "core/bvh/wide_bvh.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <span>

namespace tetrace {

/// The most references in a leaf of a binary BVH: bvh2 and bvh4 have four bits for their number.
inline constexpr std::uint32_t max_leaf_references = 15;

/// Packs a BVH in a layout of BVHs (kernels/layouts/layout.h); its boxes are enlarged by BOX_MARGIN.
/// bvh: of this mesh, valid (see find_defect). Nodes are in depth-first order, leaf triangles in the order of their
/// leaves. Throws Error{unsupported} with both numbers where the layout cannot number the references, a leaf has too
/// many, or a ray's stack would need more entries than the kernels have.
[[nodiscard]] PackedScene pack_bvh(const TriangleMesh& mesh, const Bvh& bvh, Layout layout);

/// Appends a leaf's triangles; returns the number of the first, counted in triangles.
std::uint32_t add_leaf_triangles(PackedScene& packed, const TriangleMesh& mesh,
                                 std::span<const std::uint32_t> triangles);

/// The triangles of a wide BVH's leaf in ascending order, once each even if the leaf holds two parts of one.
[[nodiscard]] std::vector<std::uint32_t> triangles_of_leaf(const WideBvh& wide, const WideChild& leaf);

/// A wide node's child's box with the margin that packed boxes have.
[[nodiscard]] Box grown_box(const WideChild& child);

/// Throws Error{unsupported}: packing a BVH as `layout` found `found` of `what`, and at most `most` fit.
[[noreturn]] void refuse_to_pack(Layout layout, std::uint64_t found, const char* what, std::uint64_t most);

} // namespace tetrace
