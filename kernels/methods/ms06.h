// Method ms06: exit face by two or three side products; the sides at the entry face's edges are known.
// Source: Marmitt and Slusallek, "Fast Ray Traversal of Tetrahedral and Hexahedral Meshes for Direct Volume Rendering",
// EuroVis 2006. 23 operations a product, as in plucker; (2 + 3 + 3) / 3 products on average.
#ifndef TETRACE_KERNELS_METHODS_MS06_H
#define TETRACE_KERNELS_METHODS_MS06_H

#include "kernels/layouts/faces.h"
#include "kernels/methods/edge_sides.h"

// Two edges to the apex bound the first candidate. If it is not the exit, the third edge decides between the other two.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = vertex(scene, tet, entry);
    real s0 = edge_product(ray, vertex(scene, tet, corner(entry, 0u)), apex);
    real s1 = edge_product(ray, vertex(scene, tet, corner(entry, 1u)), apex);
    if (s0 <= real(0.0f) && s1 >= real(0.0f)) return corner(entry, 2u);
    real s2 = edge_product(ray, vertex(scene, tet, corner(entry, 2u)), apex);
    return corner(entry, s2 >= real(0.0f) ? 0u : 1u);
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return edge_product(ray, from, to);
}

#endif
