// Exit face for methods that test the ray's side at all edges of a face. The including method defines AS_SEEN(ray,
// point), a vertex in the form that its products need, and side_of(ray, from, to) for two such vertices. Swapping the
// two must negate it exactly: an edge then has the same side in every tet.
#ifndef TETRACE_KERNELS_METHODS_WHOLE_FACE_H
#define TETRACE_KERNELS_METHODS_WHOLE_FACE_H

#include "kernels/layouts/faces.h"
#include "kernels/methods/edge_sides.h"

#define FINDS_NO_EXIT

// A face is the exit if none of its three edges has the ray on its entering side. The three candidates are tested in
// turn, each until an edge rejects it. No edge is tested twice.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = AS_SEEN(ray, vertex(scene, tet, entry));
    Vec3 c0 = AS_SEEN(ray, vertex(scene, tet, corner(entry, 0u)));
    Vec3 c1 = AS_SEEN(ray, vertex(scene, tet, corner(entry, 1u)));
    real s0 = side_of(ray, c0, apex);
    real s1 = side_of(ray, c1, apex);
    if (s0 <= real(0.0f) && s1 >= real(0.0f) && side_of(ray, c0, c1) >= real(0.0f)) return corner(entry, 2u);
    Vec3 c2 = AS_SEEN(ray, vertex(scene, tet, corner(entry, 2u)));
    real s2 = side_of(ray, c2, apex);
    if (s1 <= real(0.0f) && s2 >= real(0.0f) && side_of(ray, c1, c2) >= real(0.0f)) return corner(entry, 0u);
    if (s2 <= real(0.0f) && s0 >= real(0.0f) && side_of(ray, c2, c0) >= real(0.0f)) return corner(entry, 1u);
    return NO_EXIT;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return side_of(ray, AS_SEEN(ray, from), AS_SEEN(ray, to));
}

#endif
