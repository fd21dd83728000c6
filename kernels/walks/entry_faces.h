// Boundary faces that hold their vertices, for tets that do not store theirs.
#ifndef TETRACE_KERNELS_WALKS_ENTRY_FACES_H
#define TETRACE_KERNELS_WALKS_ENTRY_FACES_H

#include "kernels/methods/signs.h"
#include "kernels/walks/entry.h"

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

#endif
