// Method stp: exit face by scalar triple products of the ray's direction and two vertices, seen from the ray's origin.
// Source: Lagae and Dutre, "Accelerating Ray Tracing using Constrained Tetrahedralizations", EGSR 2008.
// 3 operations a vertex moved, 14 a product (9 + 5). Three or four products, at most six.
#ifndef TETRACE_KERNELS_METHODS_STP_H
#define TETRACE_KERNELS_METHODS_STP_H

#include "kernels/ray.h"

#define AS_SEEN(ray, point) sub3((point), (ray).origin)

KERNEL_FN real side_of(Ray ray, Vec3 from, Vec3 to)
{
    return dot3(ray.direction, cross3(from, to));
}

#include "kernels/methods/whole_face.h"

#endif
