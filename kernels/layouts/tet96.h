// Layout tet96 (the paper, section 4.1): a tet holds four vertices in a quad of 16 bytes each, then {half-face,
// triangle} per face.
#ifndef TETRACE_KERNELS_LAYOUTS_TET96_H
#define TETRACE_KERNELS_LAYOUTS_TET96_H

KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint4 quad = FETCH(scene, tet_quads, TET96_QUADS * tet + corner);
    return VEC3(as_real(quad.x), as_real(quad.y), as_real(quad.z));
}

#define FACE_QUAD(tet, face) (TET96_QUADS * (tet) + 4u + ((face) >> 1u))
#include "kernels/layouts/face_quads.h"

#endif
