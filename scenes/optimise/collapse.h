#pragma once

#include "scenes/optimise/vertex_move.h"

namespace tetrace {

/// Contracts an edge of a free vertex: the vertex is put onto the neighbour for which cost falls most, and the tets
/// between them vanish. A vertex on a side of the domain stays on it.
class Collapse {
public:
    explicit Collapse(EditableMesh& mesh) : mesh_(mesh) {}

    /// Returns by how much cost fell; 0 if the vertex stays, since no neighbour lowers it by more than `least`.
    double try_vertex(std::uint32_t vertex, double least);

private:
    struct Candidate {
        double cost;
        std::uint32_t vertex;
    };
    void find_candidates(std::uint32_t vertex, double limit);
    [[nodiscard]] double cost_after(std::uint32_t onto, double limit) const;
    void make_fresh(std::uint32_t vertex, std::uint32_t onto);

    EditableMesh& mesh_;
    VertexStar star_;
    std::vector<std::uint32_t> neighbours_;
    std::vector<Candidate> candidates_;
    std::vector<Corners> fresh_;
};

} // namespace tetrace
