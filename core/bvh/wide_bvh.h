#pragma once

#include "core/bvh/bvh.h"

namespace tetrace {

/// How wide a BVH may be.
struct WideShape {
    std::uint32_t children;       ///< of a node, 4 or 8
    std::uint32_t leaf_triangles; ///< of a leaf
};
inline constexpr WideShape four_wide{4, 4};
inline constexpr WideShape eight_wide{8, 3};
/// The costs that the surface area heuristic assumes for the boxes of a node together and for a leaf's triangle: a
/// choice.
inline constexpr double wide_node_cost = 1.0;
inline constexpr double wide_triangle_cost = 0.3;
inline constexpr std::size_t max_wide_children = 8;

/// A child of a wide node: a leaf if it has references, else a node.
struct WideChild {
    Box box;
    std::uint32_t node = 0;
    std::uint32_t first = 0; ///< of a leaf: its first reference
    std::uint32_t count = 0; ///< of a leaf: its references, 1 to WideShape::leaf_triangles; 0 of an inner child
};

/// 1 to WideShape::children children.
using WideNode = std::vector<WideChild>;

/// A BVH whose nodes have up to four or eight children; the root first, a child after its parent, only the root may
/// have one child.
struct WideBvh {
    std::vector<WideNode> nodes;
    std::vector<std::uint32_t> references; ///< triangles of the mesh
};

/// How a binary BVH becomes a wide one.
enum class Collapse {
    cheapest, ///< of the least cost by the surface area heuristic
    shallow, ///< two levels become one of four children, three one of eight: for trees that would be too deep otherwise
};

/// The wide BVH whose nodes and leaves are subtrees of this one.
/// bvh: valid, its leaves of one triangle and its references in the order of leaves (with_single_leaves()).
/// Source: Ylitie, Karras, Laine 2017, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs,
/// section 3 (the dynamic programme).
[[nodiscard]] WideBvh make_wide(const Bvh& bvh, const WideShape& shape, Collapse collapse);

/// Nodes on the longest path from the root to a leaf.
[[nodiscard]] std::uint32_t levels_of(const WideBvh& bvh);

} // namespace tetrace
