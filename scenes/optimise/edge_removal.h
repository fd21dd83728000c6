#pragma once

#include "scenes/optimise/editable_mesh.h"

namespace tetrace {

/// Maximum number of vertices around an edge that EdgeRemoval looks at: its work is the cube of it.
inline constexpr std::size_t max_around_edge = 8;

/// The tets around an edge, and the vertices across from it: tet i has the edge a b and ring vertices i and i + 1, so
/// that (a, b, ring[i], ring[i + 1]) is positive. The ring of an edge on the boundary is open: it begins and ends with
/// a boundary face, and has a vertex more than tets.
struct EdgeRing {
    std::uint32_t a = 0, b = 0;
    std::vector<std::uint32_t> tets, vertices;

    [[nodiscard]] bool is_open() const { return vertices.size() > tets.size(); }
};

/// For find_ring(): from whichever tet.
inline constexpr std::uint32_t from_any_tet = 0xFFFFFFFF;

/// Finds the ring of edge 0..5 (vertices 01 02 03 12 13 23) of a tet. False if an occlusive face has the edge, or it
/// has more than `most` vertices; also if a tet of the ring with a smaller number changed in round `since` or later, as
/// a sweep over all tets that changed since then looks at the edge from that one.
bool find_ring(const EditableMesh& mesh, std::uint32_t tet, std::uint32_t edge, std::size_t most, std::uint32_t since,
               EdgeRing& ring);

/// Edge removal: the tets around an edge become the 2 (n - 2) above and below a triangulation of their ring of n
/// vertices, the cheapest one whose tets may be made, found by dynamic programming over the ring's chords. Where the
/// ring is open, the two boundary faces at the edge become two others of the same side. Sources: Klincsek 1980 (minimal
/// triangulations of polygons); Freitag, Ollivier-Gooch 1997 and Shewchuk, "Two discrete optimization algorithms for
/// the topological improvement of tetrahedral meshes", 2002 (edge removal).
class EdgeRemoval {
public:
    explicit EdgeRemoval(EditableMesh& mesh) : mesh_(mesh) {}

    /// Removes an edge of a tet where cost falls by more than `least`; returns by how much it fell, 0 if it stays.
    double try_edge(std::uint32_t tet, std::uint32_t edge, double least);

    /// Tets that changed in an earlier round are not visited: an edge is looked at from the first of the others only.
    std::uint32_t since = 1;

private:
    [[nodiscard]] bool ends_on_one_side() const;
    void triangulate(double limit);
    void emit(std::size_t i, std::size_t k);
    [[nodiscard]] Double3 ring_point(std::size_t i) const { return mesh_.point(ring_.vertices[i]); }

    EditableMesh& mesh_;
    EdgeRing ring_;
    /// Of the part i..k of the ring: cost of its cheapest triangulation, chord i k included; its middle vertex.
    std::array<std::array<double, max_around_edge>, max_around_edge> cost_{};
    std::array<std::array<std::size_t, max_around_edge>, max_around_edge> middle_{};
    std::vector<Corners> fresh_;
};

/// Face removal, the inverse of removing an edge with three tets: the two tets of a free face become three around the
/// edge between the vertices opposite it. Returns by how much cost fell; 0 if the face stays, since cost would fall
/// by `least` or less, or a tet may not be made. face: 0..3.
double try_face(EditableMesh& mesh, std::uint32_t tet, std::uint32_t face, double least);

} // namespace tetrace
