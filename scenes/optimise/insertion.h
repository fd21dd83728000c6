#pragma once

#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/vertex_move.h"

namespace tetrace {

/// Inserts a vertex near the middle of an edge: the tets around the edge, and others that pay, are replaced by the tets
/// of the vertex and their outer faces. The cavity grows by the neighbour that lowers cost most, a few steps past the
/// best too, and the vertex then moves to the cheapest point of it. On an edge of the domain's boundary, the vertex
/// stays on the sides that the edge is on.
class Insertion {
public:
    explicit Insertion(EditableMesh& mesh) : mesh_(mesh) {}

    /// Returns by how much cost fell; 0 if nothing changed, since it would not fall by more than `least`, and
    /// min_share of the area of the free faces in the cavity.
    double try_edge(std::uint32_t tet, std::uint32_t edge, double least);

    std::uint32_t since = 1;  ///< as in EdgeRemoval
    double min_ring_area = 0; ///< of the faces around an edge, for it to be tried: small ones gain little

    static constexpr double min_share = 1e-3;

private:
    struct Candidate {
        std::uint32_t tet;
        double change; ///< of cost, if it joins the cavity
    };
    [[nodiscard]] bool is_on_box(std::uint32_t p, std::uint32_t q) const;
    [[nodiscard]] bool is_flush(const Tet& tet, std::uint32_t face) const;
    [[nodiscard]] bool sees(Double3 at, const Tet& tet, std::uint32_t face) const;
    [[nodiscard]] double spokes(Double3 at, const Tet& tet, std::uint32_t face) const;
    [[nodiscard]] double face_area(const Tet& tet, std::uint32_t face) const;
    [[nodiscard]] double change_by(Double3 at, std::uint32_t tet) const;
    void add_neighbours(Double3 at, std::uint32_t tet);
    void join(Double3 at, std::uint32_t tet);
    [[nodiscard]] double grow(Double3 at);
    void find_outside();
    [[nodiscard]] double ring_area() const;
    [[nodiscard]] bool may_be_at(Double3 at) const;
    [[nodiscard]] Double3 better_point(Double3 at) const;

    EditableMesh& mesh_;
    EdgeRing ring_;
    BoxSides sides_ = 0; ///< of the box, that the vertex is to lie on
    std::vector<std::uint32_t> cavity_;
    std::vector<Candidate> candidates_;
    VertexStar outside_; ///< of the vertex to be: its edges
    std::vector<std::array<std::uint32_t, 3>> faces_;
    double inside_area_ = 0; ///< of the free faces between tets of the cavity
    std::vector<Corners> fresh_;
};

} // namespace tetrace
