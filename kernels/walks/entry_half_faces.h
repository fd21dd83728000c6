// Boundary faces as half-faces to tets that hold their corners.
#ifndef TETRACE_KERNELS_WALKS_ENTRY_HALF_FACES_H
#define TETRACE_KERNELS_WALKS_ENTRY_HALF_FACES_H

#include KERNEL_LAYOUT_HEADER
#include KERNEL_METHOD_HEADER
#include "kernels/layouts/faces.h"
#include "kernels/walks/entry.h"

KERNEL_FN EntryFace entry_face(SceneView scene, uint index)
{
    uint half_face = FETCH(scene, entry_half_faces, index);
    EntryFace face;
    face.a = vertex(scene, half_face >> 2u, corner(half_face & 3u, 0u));
    face.b = vertex(scene, half_face >> 2u, corner(half_face & 3u, 1u));
    face.c = vertex(scene, half_face >> 2u, corner(half_face & 3u, 2u));
    return face;
}

// The half-face of a boundary face; NO_HALF_FACE for NO_ENTRY, and for a deferred ray.
KERNEL_FN uint entry_half_face(SceneView scene, uint index)
{
    return index >= DEFERRED ? NO_HALF_FACE : FETCH(scene, entry_half_faces, index);
}

#endif
