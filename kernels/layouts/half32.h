// Layout half32: for each tet and each face by which a ray may enter it, one aligned record of 32 bytes with everything
// that a step needs: the new vertex, and what is across each of the three other faces (layout.h). A record's number is
// its half-face.
#ifndef TETRACE_KERNELS_LAYOUTS_HALF32_H
#define TETRACE_KERNELS_LAYOUTS_HALF32_H

#include "kernels/layouts/faces.h"

#define HAS_RECORDS
#define RecordExits uint4
#define RECORD_EXITS(scene, record) record_exits(scene, record)
#define ROTATION_OF_CORNERS(face) 0u                  // of a walk that carries them in the order of faces.h
#define ROTATION_AFTER(rotation, replaced) (rotation) // once the apex has replaced a vertex
#define EXIT_REPLACING(scene, exits, rotation, replaced) exit_replacing(exits, rotation, replaced)

KERNEL_FN uint4 record_apex(SceneView scene, uint record)
{
    return FETCH(scene, tet_quads, HALF32_QUADS * record);
}

KERNEL_FN RecordExits record_exits(SceneView scene, uint record)
{
    return FETCH(scene, tet_quads, HALF32_QUADS * record + 1u);
}

// Record of a corner of a record's entry face: the one whose apex it is.
KERNEL_FN uint record_of_corner(uint record, uint index)
{
    return (record & ~3u) | corner(record & 3u, index);
}

KERNEL_FN uint exit_to(uint record)
{
    return record << 2u;
}

KERNEL_FN uint record_across(uint exit)
{
    return exit >> 2u;
}

KERNEL_FN uint rotation_at(uint rotation, uint exit)
{
    uint sum = rotation + (exit & 3u);
    return sum >= 3u ? sum - 3u : sum;
}

KERNEL_FN uint exit_replacing(RecordExits exits, uint rotation, uint replaced)
{
    uint index = replaced < rotation ? replaced + 3u - rotation : replaced - rotation;
    return index == 0u ? exits.x : index == 1u ? exits.y : exits.z;
}

// The vertex opposite the record's face.
KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint4 apex = record_apex(scene, (tet << 2u) | corner);
    return VEC3(as_real(apex.x), as_real(apex.y), as_real(apex.z));
}

KERNEL_FN uint opposite_half_face(SceneView scene, uint tet, uint face)
{
    return record_exits(scene, (tet << 2u) | face).w;
}

// The exit through `face`, from the record of another face of its tet. Corners 0, 1, 2 of face 0 are vertices 1, 2, 3;
// corner 0 of face 1 is vertex 0.
KERNEL_FN uint exit_through(SceneView scene, uint tet, uint face)
{
    uint4 exits = record_exits(scene, (tet << 2u) | (face == 0u ? 1u : 0u));
    return face <= 1u ? exits.x : face == 2u ? exits.y : exits.z;
}

KERNEL_FN uint face_triangle(SceneView scene, uint tet, uint face)
{
    uint exit = exit_through(scene, tet, face);
    return (exit & 3u) == EXIT_END && exit != NO_HALF_FACE ? record_across(exit) : FREE_FACE;
}

#endif
