// Layout tet64: a tet is one cache line of four records, one for each face by which a ray may enter it: the new vertex,
// and what is across the face opposite that vertex (layout.h). A step loads the record's vertex, then what is across
// one other face, as a word of another record of the same line. A record's number is its half-face. The corners of face
// f are here f ^ 1, f ^ 2, f ^ 3: those of faces.h, rotated (docs/spec/layouts.md, L13).
#ifndef TETRACE_KERNELS_LAYOUTS_TET64_H
#define TETRACE_KERNELS_LAYOUTS_TET64_H

#define HAS_RECORDS
#define RecordExits uint
#define RECORD_EXITS(scene, record) (record)
#define TRIANGLE_OF(row, first) ((first).w - NORMAL_BIAS)
#define ROTATION_OF_CORNERS(face) rotation_of_corners(face)
#define ROTATION_AFTER(rotation, replaced) rotation_after(rotation, replaced)
#define EXIT_REPLACING(scene, exits, rotation, replaced) exit_replacing(scene, exits, rotation, replaced)

KERNEL_FN uint4 record_apex(SceneView scene, uint record)
{
    return FETCH(scene, tet_quads, record);
}

KERNEL_FN uint record_of_corner(uint record, uint index)
{
    return record ^ (index + 1u);
}

KERNEL_FN uint exit_to(uint record)
{
    return ((EXIT_IS_NORMAL >> 2u) | record) << 2u; // in this form compilers see that it is not an end
}

KERNEL_FN uint record_across(uint exit)
{
    return (exit & (EXIT_IS_NORMAL - 1u)) >> 2u;
}

// 0, 0, 2, 1 for faces 0 to 3.
KERNEL_FN uint rotation_of_corners(uint face)
{
    return (0x60u >> (2u * face)) & 3u;
}

// Not reduced: the rotation, or 3 more.
KERNEL_FN uint rotation_at(uint rotation, uint exit)
{
    return rotation + (exit & 3u);
}

// (2 - rotation - replaced) mod 3: the next exit's fold is added to it.
KERNEL_FN uint rotation_after(uint rotation, uint replaced)
{
    uint by_rotation = replaced == 0u ? 0x186u : replaced == 1u ? 0x61u : 0x218u;
    return (by_rotation >> (2u * rotation)) & 3u;
}

// The corner's number is (replaced - rotation) mod 3. For UNDECIDED it is any.
KERNEL_FN uint exit_replacing(SceneView scene, RecordExits record, uint rotation, uint replaced)
{
    uint by_rotation = replaced == 0u ? 0x36Du : replaced == 1u ? 0x1B6u : 0x2DBu;
    uint corner_and_1 = (by_rotation >> (2u * rotation)) & 3u;
    return FETCH(scene, tet_quads, record ^ corner_and_1).w;
}

KERNEL_FN Vec3 place_of(uint4 apex)
{
    return VEC3(as_real(apex.x), as_real(apex.y), as_real(apex.z));
}

KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    return place_of(record_apex(scene, (tet << 2u) | corner));
}

KERNEL_FN uint exit_through(SceneView scene, uint tet, uint face)
{
    return record_apex(scene, (tet << 2u) | face).w;
}

// The row of an occlusive face, or NO_HALF_FACE.
KERNEL_FN uint row_at(SceneView scene, uint tet, uint face)
{
    uint exit = exit_through(scene, tet, face);
    return (exit & 3u) == EXIT_END && exit != NO_HALF_FACE ? record_across(exit) : NO_HALF_FACE;
}

KERNEL_FN uint face_triangle(SceneView scene, uint tet, uint face)
{
    uint row = row_at(scene, tet, face);
    if (row == NO_HALF_FACE) return FREE_FACE;
    return FETCH(scene, triangles, TRIANGLE_QUADS * row).w - NORMAL_BIAS;
}

KERNEL_FN uint opposite_half_face(SceneView scene, uint tet, uint face)
{
    uint exit = exit_through(scene, tet, face);
    uint row = row_at(scene, tet, face);
    if (exit == NO_HALF_FACE || row == NO_HALF_FACE) return exit == NO_HALF_FACE ? NO_HALF_FACE : record_across(exit);
    uint one = FETCH(scene, triangles, TRIANGLE_QUADS * row + 1u).w;
    uint other = FETCH(scene, triangles, TRIANGLE_QUADS * row + 2u).w;
    uint behind = one == (EXIT_IS_NORMAL | (tet << 2u) | face) ? other : one;
    return behind == NO_HALF_FACE ? NO_HALF_FACE : behind & (EXIT_IS_NORMAL - 1u);
}

#endif
