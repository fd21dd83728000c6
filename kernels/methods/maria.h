// Method maria: exit face by two side products in the frame of the complement vertex.
// Source: Maria, Horna, Aveneau, "Efficient Ray Traversal of Constrained Delaunay Tetrahedralization", GRAPP 2017,
// sections 3.1 to 3.4. 28 operations per step: 9 + 3 for the moment, twice 3 + 5 for a side product.
#ifndef TETRACE_KERNELS_METHODS_MARIA_H
#define TETRACE_KERNELS_METHODS_MARIA_H

#include "kernels/layouts/faces.h"
#include "kernels/methods/edge_sides.h"

#define TAKES_RAYS // the other methods are compared on primary rays, as in the paper

KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = vertex(scene, tet, entry);
    Vec3 moment =
        sub3(ray.moment, cross3(apex, ray.direction)); // origin moved to the apex: the moments of its edges vanish
    real side = dot3(moment, sub3(apex, vertex(scene, tet, corner(entry, 2u))));
    uint outcome = side >= real(0.0f) ? 1u : 0u;
    side = dot3(moment, sub3(apex, vertex(scene, tet, corner(entry, outcome))));
    outcome += side < real(0.0f) ? 1u : 0u;
    return other_face(entry, outcome);
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return side_of_edge(ray, from, to);
}

#endif
