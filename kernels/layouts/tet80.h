// Layout tet80 (the paper, section 4.1): a tet holds its vertices as 12 floats, then {half-face, triangle} per face.
#ifndef TETRACE_KERNELS_LAYOUTS_TET80_H
#define TETRACE_KERNELS_LAYOUTS_TET80_H

#ifdef QUADS_COST_AS_WORDS
#include "kernels/layouts/tet80_quads.h"
#else
#define TET80_WORDS (4u * TET80_QUADS)

KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint word = TET80_WORDS * tet + 3u * corner;
    return VEC3(as_real(FETCH(scene, tet_words, word)), as_real(FETCH(scene, tet_words, word + 1u)),
                as_real(FETCH(scene, tet_words, word + 2u)));
}

KERNEL_FN uint opposite_half_face(SceneView scene, uint tet, uint face)
{
    return FETCH(scene, tet_words, TET80_WORDS * tet + 12u + 2u * face);
}

KERNEL_FN uint face_triangle(SceneView scene, uint tet, uint face)
{
    return FETCH(scene, tet_words, TET80_WORDS * tet + 13u + 2u * face);
}
#endif

#endif
