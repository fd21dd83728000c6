// Layout half32: for each tet and each face by which a ray may enter it, one aligned record of 32 bytes with everything
// that a step needs: the new vertex, and what lies behind each of the three other faces (layout.h). A link is its
// record's number.
#define HAS_RECORDS
#define RecordExits uint4
#define RECORD_EXITS(scene, record) record_exits(scene, record)
#define TURN_OF_CORNERS(face) 0u          // of a walk that carries them in the order of faces.h
#define TURN_AFTER(turn, replaced) (turn) // once the apex has replaced a vertex
#define EXIT_REPLACING(scene, exits, turn, replaced) exit_replacing(exits, turn, replaced)

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

KERNEL_FN uint record_behind(uint exit)
{
    return exit >> 2u;
}

KERNEL_FN uint turn_behind(uint turn, uint exit)
{
    uint sum = turn + (exit & 3u);
    return sum >= 3u ? sum - 3u : sum;
}

KERNEL_FN uint exit_replacing(RecordExits exits, uint turn, uint replaced)
{
    uint index = replaced < turn ? replaced + 3u - turn : replaced - turn;
    return index == 0u ? exits.x : index == 1u ? exits.y : exits.z;
}

// The vertex opposite the record's face.
KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint4 apex = record_apex(scene, (tet << 2u) | corner);
    return VEC3(as_real(apex.x), as_real(apex.y), as_real(apex.z));
}

KERNEL_FN uint face_link(SceneView scene, uint tet, uint face)
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
    return (exit & 3u) == EXIT_END && exit != NO_LINK ? record_behind(exit) : FREE_FACE;
}
