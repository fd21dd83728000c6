#pragma once

#include "core/mesh/box.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A node of a binary BVH: a leaf if it has references, else an inner node with two children.
struct BvhNode {
    Box box;                                 ///< of all triangles below, without a margin
    std::array<std::uint32_t, 2> child = {}; ///< of an inner node
    std::uint32_t first = 0;                 ///< of a leaf: its first reference
    std::uint32_t count = 0;                 ///< of a leaf: number of references; 0: an inner node

    friend bool operator==(const BvhNode&, const BvhNode&) = default;
};

/// A binary BVH over a triangle mesh, independent of packed layouts and of the library that built it.
struct Bvh {
    std::vector<BvhNode> nodes;            ///< the root first; a child after its parent
    std::vector<std::uint32_t> references; ///< triangles of the mesh; a split one is in several leaves

    friend bool operator==(const Bvh&, const Bvh&) = default;
};

/// Inner nodes on the longest path from the root to a leaf: the most far children that can wait on a ray's stack.
/// Precondition: children come after their parents.
[[nodiscard]] std::uint32_t depth_of(const Bvh& bvh);

/// What is wrong with a BVH of this mesh; empty if nothing is. Each node but the root is the child of one node and
/// comes after it; its box is in its parent's; each reference belongs to one leaf; a leaf names existing triangles once
/// each; the leaves of a triangle together cover its box.
[[nodiscard]] std::optional<std::string> find_defect(const Bvh& bvh, const TriangleMesh& mesh);

/// A BVH of the least depth: triangles are halved by their boxes' centres along the longest axis until at most 4 are
/// left. It traces more slowly than a tree by the surface area heuristic, and serves meshes for which that is too deep.
/// mesh: at least one triangle, finite.
[[nodiscard]] Bvh build_balanced_bvh(const TriangleMesh& mesh);

/// The boxes of a triangle's two parts.
struct TriangleParts {
    Box below, above;
};

/// Cuts a triangle at a plane across an axis. Returns the boxes of the parts on either side that lie in `box`, rounded
/// outwards; empty if that part is empty. What is in the plane is in both.
[[nodiscard]] TriangleParts split_triangle(const Float3 (&corners)[3], int axis, float position, const Box& box);

/// The same BVH with each leaf split, at the least surface area, until leaves have one triangle. References are in the
/// order of the leaves, so the references below a node are contiguous.
/// bvh: valid for this mesh (see find_defect).
[[nodiscard]] Bvh with_single_leaves(const TriangleMesh& mesh, const Bvh& bvh);

} // namespace tetrace
