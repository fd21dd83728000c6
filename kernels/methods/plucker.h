// Method plucker: exit face by the permuted inner products of the Pluecker coordinates of ray and edges.
// Sources: Platis and Theoharis, "Fast Ray-Tetrahedron Intersection Using Pluecker Coordinates", Journal of Graphics
// Tools 8(4), 2003; Lagae and Dutre, "Accelerating Ray Tracing using Constrained Tetrahedralizations", EGSR 2008.
// 23 operations a product: 3 for the edge's direction, 9 for its moment, 5 + 5 + 1. Three or four products, at most
// six.
#ifndef TETRACE_KERNELS_METHODS_PLUCKER_H
#define TETRACE_KERNELS_METHODS_PLUCKER_H

#include "kernels/methods/edge_sides.h"

#define AS_SEEN(ray, point) (point)

KERNEL_FN real side_of(Ray ray, Vec3 from, Vec3 to)
{
    return edge_product(ray, from, to);
}

#include "kernels/methods/whole_face.h"

#endif
