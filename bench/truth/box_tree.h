#pragma once

#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace tetrace {

/// A tree of the boxes of a mesh's triangles, which shares nothing with the kernels' BVHs or Embree's.
class BoxTree {
public:
    struct Node {
        float low[3], high[3];
        std::uint32_t first = 0; ///< of its triangles in the tree's order, or of its two children
        std::uint32_t count = 0; ///< triangles; 0: it has children
    };

    /// Precondition: the mesh's coordinates are finite.
    explicit BoxTree(const TriangleMesh& mesh);

    /// Calls visit(triangle) for the triangles of each leaf, nearer leaves first. entry_of(node): where the ray enters
    /// a node's box, or infinity where it does not. is_needless(entry): whether nothing from there on is wanted any
    /// more.
    template <class EntryOf, class IsNeedless, class Visit>
    void visit(const EntryOf& entry_of, const IsNeedless& is_needless, const Visit& visit) const
    {
        constexpr double nowhere = std::numeric_limits<double>::infinity();
        struct Waiting {
            std::uint32_t node;
            double entry;
        };
        std::array<Waiting, 128> waiting;
        std::size_t count = 0;
        if (order_.empty()) return;
        if (const double entry = entry_of(nodes_[0]); entry < nowhere) waiting[count++] = {0, entry};
        while (count > 0) {
            const auto [number, entry] = waiting[--count];
            if (is_needless(entry)) continue;
            const Node& node = nodes_[number];
            if (node.count > 0) {
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                    visit(order_[i]);
                continue;
            }
            const double left = entry_of(nodes_[node.first]), right = entry_of(nodes_[node.first + 1]);
            const std::uint32_t nearer = left <= right ? 0 : 1;
            if (std::max(left, right) < nowhere) waiting[count++] = {node.first + 1 - nearer, std::max(left, right)};
            if (std::min(left, right) < nowhere) waiting[count++] = {node.first + nearer, std::min(left, right)};
        }
    }

private:
    struct Builder;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

} // namespace tetrace
