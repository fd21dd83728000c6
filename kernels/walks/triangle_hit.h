// The hit at the end of a walk, on an input triangle.
#ifndef TETRACE_KERNELS_WALKS_TRIANGLE_HIT_H
#define TETRACE_KERNELS_WALKS_TRIANGLE_HIT_H

#include "kernels/hit.h"

// The input triangle of a row, whose first quad is `first`; a layout whose exits name rows of its own defines it.
#ifndef TRIANGLE_OF
#define TRIANGLE_OF(row, first) (row)
#endif

// The hit on an input triangle; NO_HIT if the ray ends before it.
KERNEL_FN Hit hit_on(SceneView scene, Ray ray, uint row, uint tet, uint steps, real end)
{
    uint4 r0 = FETCH(scene, triangles, TRIANGLE_QUADS * row);
    uint4 r1 = FETCH(scene, triangles, TRIANGLE_QUADS * row + 1u);
    uint4 r2 = FETCH(scene, triangles, TRIANGLE_QUADS * row + 2u);
    Vec3 v0 = VEC3(as_real(r0.x), as_real(r0.y), as_real(r0.z));
    Vec3 edge_1 = VEC3(as_real(r1.x), as_real(r1.y), as_real(r1.z));
    Vec3 edge_2 = VEC3(as_real(r2.x), as_real(r2.y), as_real(r2.z));
    if (is_beyond(ray, v0, edge_1, edge_2, end)) return make_no_hit(NO_HIT, tet, steps);
    return make_hit(ray, TRIANGLE_OF(row, r0), v0, edge_1, edge_2, tet, steps);
}

#endif
