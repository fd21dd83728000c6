// Layout tet80 (the paper, section 4.1): a tet holds its vertices as 12 floats, then {half-face, triangle} per face.
#ifndef TETRACE_KERNELS_LAYOUTS_TET80_H
#define TETRACE_KERNELS_LAYOUTS_TET80_H

#ifdef QUADS_COST_AS_WORDS
// Layout tet80 on devices where reading a quad costs as much as reading a word: every vertex is taken from the three
// quads that hold all four vertices, so the quads are read once per tet.
KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint4 a = FETCH(scene, tet_quads, TET80_QUADS * tet);
    uint4 b = FETCH(scene, tet_quads, TET80_QUADS * tet + 1u);
    uint4 c = FETCH(scene, tet_quads, TET80_QUADS * tet + 2u);
    uint x = corner < 2u ? (corner == 0u ? a.x : a.w) : (corner == 2u ? b.z : c.y);
    uint y = corner < 2u ? (corner == 0u ? a.y : b.x) : (corner == 2u ? b.w : c.z);
    uint z = corner < 2u ? (corner == 0u ? a.z : b.y) : (corner == 2u ? c.x : c.w);
    return VEC3(as_real(x), as_real(y), as_real(z));
}

#define FACE_QUAD(tet, face) (TET80_QUADS * (tet) + 3u + ((face) >> 1u))
#include "kernels/layouts/face_quads.h"
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
