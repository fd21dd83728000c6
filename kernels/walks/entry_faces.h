// Boundary faces that rays enter by, with their vertices, into tets that cannot name theirs.
STRUCT(EntryFace)
{
    Vec3 a; // in the order of faces.h
    Vec3 b;
    Vec3 c;
};

KERNEL_FN Vec3 position_of(SceneView scene, uint vertex)
{
    uint4 quad = FETCH(scene, vertices, vertex);
    return VEC3(as_real(quad.x), as_real(quad.y), as_real(quad.z));
}

KERNEL_FN EntryFace entry_face(SceneView scene, uint index)
{
    uint4 quad = FETCH(scene, entry_faces, index);
    EntryFace face;
    face.a = position_of(scene, quad.x);
    face.b = position_of(scene, quad.y);
    face.c = position_of(scene, quad.z);
    return face;
}

#include "kernels/walks/entry.h"
