#pragma once

#include "scenes/optimise/editable_mesh.h"
#include "scenes/optimise/shape.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// The tets of a free vertex, and the edges of its link. The free faces that have the vertex are the triangles of it
/// and these edges; boundary faces cost nothing.
struct VertexStar {
    struct LinkEdge {
        std::uint32_t p, q;
        std::uint32_t left, right; ///< the link's triangles on both sides are p q left and p q right
    };
    std::vector<std::uint32_t> tets;
    std::vector<LinkEdge> edges;

    /// Sum of the areas of the free faces that have the vertex, were it at `at`.
    [[nodiscard]] double cost(const EditableMesh& mesh, Double3 at) const
    {
        double sum = 0;
        for (const LinkEdge& edge : edges)
            sum += area(at, mesh.point(edge.p), mesh.point(edge.q));
        return sum;
    }
};

/// Finds the star of a free vertex. False if it has more than `most` tets.
bool find_star(EditableMesh& mesh, std::uint32_t vertex, std::size_t most, VertexStar& star);

} // namespace tetrace
