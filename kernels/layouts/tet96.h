// Layout tet96 (the paper, section 4.1): a tet holds four vertices in a row of 16 bytes each, then {link, triangle} per
// face.
KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint4 row = FETCH(scene, tet_rows, TET96_ROWS * tet + corner);
    return VEC3(as_real(row.x), as_real(row.y), as_real(row.z));
}

#define FACE_ROW(tet, face) (TET96_ROWS * (tet) + 4u + ((face) >> 1u))
#include "kernels/layouts/face_rows.h"
