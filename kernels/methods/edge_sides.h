// The sides of a ray at the edges of a tet, as the methods of the paper take them, and the exit face of the tet that a
// ray starts in, for methods that need an entry face.
#ifndef TETRACE_KERNELS_METHODS_EDGE_SIDES_H
#define TETRACE_KERNELS_METHODS_EDGE_SIDES_H

#include KERNEL_LAYOUT_HEADER
#include "kernels/ray.h"

// Side of the ray with respect to the directed line from vertex `from` to vertex `to` (Pluecker side product), in the
// frame of `from`: the line's moment vanishes there.
KERNEL_FN real side_of_edge(Ray ray, Vec3 from, Vec3 to)
{
    return dot3(cross3(sub3(ray.origin, from), ray.direction), sub3(to, from));
}

// The same as the permuted inner product of Pluecker coordinates, {direction, moment} of the ray and {to - from, from x
// to} of the edge. Swapping from and to negates it exactly.
KERNEL_FN real edge_product(Ray ray, Vec3 from, Vec3 to)
{
    PRECISE real product = dot3(ray.moment, sub3(to, from)) + dot3(ray.direction, cross3(from, to));
    return product;
}

// A ray enters this tet by none of its faces; three side products decide among the four. Each edge excludes one of its
// two faces; edges 23 and 01 leave one face of {0, 1} and one of {2, 3}, and the edge that those two share decides.
KERNEL_FN uint start_face_by_edges(SceneView scene, uint tet, Ray ray)
{
    real side = side_of_edge(ray, vertex(scene, tet, 2u), vertex(scene, tet, 3u));
    uint low = side >= real(0.0f) ? 1u : 0u;
    side = side_of_edge(ray, vertex(scene, tet, 0u), vertex(scene, tet, 1u));
    uint high = side >= real(0.0f) ? 3u : 2u;
    side = side_of_edge(ray, vertex(scene, tet, 1u - low), vertex(scene, tet, 5u - high));
    bool positive = side >= real(0.0f);
    bool even = low + 2u == high;
    return positive == even ? low : high;
}

#endif
