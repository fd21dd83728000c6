// Layout half32: for each tet and each face by which a ray may enter it, one aligned record of 32 bytes with everything
// that a step needs: the new vertex, and what lies behind each of the three other faces (layout.h). A link is its
// record's number.
#define HAS_RECORDS

KERNEL_FN uint4 record_apex(SceneView scene, uint record)
{
    return FETCH(scene, tet_quads, HALF32_QUADS * record);
}

KERNEL_FN uint4 record_exits(SceneView scene, uint record)
{
    return FETCH(scene, tet_quads, HALF32_QUADS * record + 1u);
}

// The vertex opposite the record's face.
KERNEL_FN Vec3 vertex(SceneView scene, uint tet, uint corner)
{
    uint4 apex = record_apex(scene, (tet << 2u) | corner);
    return VEC3(as_real(apex.x), as_real(apex.y), as_real(apex.z));
}

KERNEL_FN uint vertex_rank(SceneView scene, uint tet, uint corner)
{
    return record_apex(scene, (tet << 2u) | corner).w;
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
    return (exit & 3u) == HALF32_END && exit != NO_LINK ? exit >> 2u : FREE_FACE;
}
