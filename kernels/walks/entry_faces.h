// Boundary faces that rays enter by, with their vertices, into tets that cannot name theirs.
STRUCT(EntryFace)
{
    Vec3 a; // in the order of faces.h
    Vec3 b;
    Vec3 c;
};

KERNEL_FN Vec3 position_of(SceneView scene, uint vertex)
{
    uint4 row = FETCH(scene, vertices, vertex);
    return VEC3(as_real(row.x), as_real(row.y), as_real(row.z));
}

KERNEL_FN EntryFace entry_face(SceneView scene, uint index)
{
    uint4 row = FETCH(scene, entry_faces, index);
    EntryFace face;
    face.a = position_of(scene, row.x);
    face.b = position_of(scene, row.y);
    face.c = position_of(scene, row.z);
    return face;
}

#include "kernels/walks/entry.h"
