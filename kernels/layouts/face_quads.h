// Faces of a tet that is read by quads, two {half-face, triangle} per quad. The including layout defines FACE_QUAD(tet,
// face), the number of a face's quad.
KERNEL_FN uint opposite_half_face(SceneView scene, uint tet, uint face)
{
    uint4 quad = FETCH(scene, tet_quads, FACE_QUAD(tet, face));
    return (face & 1u) == 0u ? quad.x : quad.z;
}

KERNEL_FN uint face_triangle(SceneView scene, uint tet, uint face)
{
    uint4 quad = FETCH(scene, tet_quads, FACE_QUAD(tet, face));
    return (face & 1u) == 0u ? quad.y : quad.w;
}
