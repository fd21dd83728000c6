// Faces of a tet that is read by rows, two {link, triangle} a row. The layout, which includes this, brings
// FACE_ROW(tet, face), the number of a face's row.
KERNEL_FN uint face_link(SceneView scene, uint tet, uint face)
{
    uint4 row = FETCH(scene, tet_rows, FACE_ROW(tet, face));
    return (face & 1u) == 0u ? row.x : row.z;
}

KERNEL_FN uint face_triangle(SceneView scene, uint tet, uint face)
{
    uint4 row = FETCH(scene, tet_rows, FACE_ROW(tet, face));
    return (face & 1u) == 0u ? row.y : row.w;
}
