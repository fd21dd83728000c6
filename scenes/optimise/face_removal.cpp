#include "scenes/optimise/face_removal.h"

#include "core/mesh/face_corners.h"
#include "scenes/optimise/shape.h"

namespace tetrace {

double try_face(EditableMesh& mesh, std::uint32_t tet, std::uint32_t face, double least)
{
    const Tet& here = mesh.tet(tet);
    const std::uint32_t link = here.links[face];
    if (link == NO_LINK || here.faces[face] != FREE_FACE) return 0;
    const std::uint32_t a = here.vertices[face], b = mesh.tet(link_tet(link)).vertices[link_face(link)];
    const auto& [i, j, k] = face_corners[face];
    const std::uint32_t p = here.vertices[i], q = here.vertices[j], r = here.vertices[k];
    double gain = area(mesh.point(p), mesh.point(q), mesh.point(r));
    for (const std::uint32_t corner : {p, q, r}) {
        gain -= area(mesh.point(a), mesh.point(b), mesh.point(corner));
        if (gain <= least) return 0;
    }
    const std::array<std::uint32_t, 2> old = {tet, link_tet(link)};
    const std::array<Corners, 3> fresh = {{{a, b, p, q}, {a, b, q, r}, {a, b, r, p}}};
    return mesh.replace(old, fresh) ? gain : 0;
}

} // namespace tetrace
