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
