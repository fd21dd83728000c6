#include "scenes/optimise/vertex_star.h"

namespace tetrace {
namespace {

// The faces of a star's tet that have the vertex, each for the one of its two tets with the smaller number.
void add_edges(const EditableMesh& mesh, std::uint32_t vertex, std::uint32_t index, VertexStar& star)
{
    const Tet& tet = mesh.tet(index);
    for (std::uint32_t face = 0; face < 4; ++face) {
        const std::uint32_t half_face = tet.neighbours[face];
        if (tet.vertices[face] == vertex || half_face == NO_HALF_FACE || half_face_tet(half_face) < index) continue;
        VertexStar::LinkEdge edge{NO_TET, NO_TET, tet.vertices[face],
                                  mesh.tet(half_face_tet(half_face)).vertices[half_face_index(half_face)]};
        for (std::uint32_t i = 0; i < 4; ++i)
            if (i != face && tet.vertices[i] != vertex) (edge.p == NO_TET ? edge.p : edge.q) = tet.vertices[i];
        star.edges.push_back(edge);
    }
}

} // namespace

bool find_star(EditableMesh& mesh, std::uint32_t vertex, std::size_t most, VertexStar& star)
{
    star.tets.assign(1, mesh.tet_of(vertex));
    star.edges.clear();
    mesh.unmark_all();
    mesh.mark(star.tets.front());
    for (std::size_t i = 0; i < star.tets.size(); ++i) {
        if (star.tets.size() > most) return false;
        const Tet& tet = mesh.tet(star.tets[i]);
        for (std::uint32_t face = 0; face < 4; ++face)
            if (tet.vertices[face] != vertex && tet.neighbours[face] != NO_HALF_FACE &&
                mesh.mark(half_face_tet(tet.neighbours[face])))
                star.tets.push_back(half_face_tet(tet.neighbours[face]));
        add_edges(mesh, vertex, star.tets[i], star);
    }
    return true;
}

} // namespace tetrace
