#pragma once

#include "core/mesh/box.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A node of a binary BVH: a leaf where it has references, else one with two children.
struct BvhNode {
    Box box;                                 ///< of all below, as they are: no margin
    std::array<std::uint32_t, 2> child = {}; ///< of an inner node
    std::uint32_t first = 0;                 ///< of a leaf: its first reference
    std::uint32_t count = 0;                 ///< of a leaf: its references; 0 says that the node is an inner one

    friend bool operator==(const BvhNode&, const BvhNode&) = default;
};

/// A binary BVH over a triangle mesh, free of any packed layout and of the library that built it.
struct Bvh {
    std::vector<BvhNode> nodes;            ///< the root first; a child after its parent
    std::vector<std::uint32_t> references; ///< triangles of the mesh; one that was split stands in several leaves

    friend bool operator==(const Bvh&, const Bvh&) = default;
};

/// Inner nodes on the longest way from the root to a leaf: at most so many far children wait while a ray is traced.
/// Precondition: children stand after their parents.
[[nodiscard]] std::uint32_t depth_of(const Bvh& bvh);

/// What is wrong with a BVH of this mesh, or nothing: each node but the root is one node's child and stands after it,
/// its box lies in its parent's, leaves share out the references without rest, name existing triangles once each, and
/// all leaves of a triangle together have its box.
[[nodiscard]] std::optional<std::string> find_defect(const Bvh& bvh, const TriangleMesh& mesh);

} // namespace tetrace
