// The walk from tet to tet, and the hit at its end. A method brings exit_face() and start_face(), which return a face
// of the tet, or NO_EXIT.

// The hit on an input triangle, loaded.
KERNEL_FN Hit hit_on(SceneView scene, Ray ray, uint triangle, uint tet, uint steps)
{
    uint4 r0 = FETCH(scene, triangles, TRIANGLE_ROWS * triangle);
    uint4 r1 = FETCH(scene, triangles, TRIANGLE_ROWS * triangle + 1u);
    uint4 r2 = FETCH(scene, triangles, TRIANGLE_ROWS * triangle + 2u);
    Vec3 v0 = VEC3(as_real(r0.x), as_real(r0.y), as_real(r0.z));
    Vec3 edge_1 = VEC3(as_real(r1.x), as_real(r1.y), as_real(r1.z));
    Vec3 edge_2 = VEC3(as_real(r2.x), as_real(r2.y), as_real(r2.z));
    return make_hit(ray, triangle, v0, edge_1, edge_2, tet, steps);
}

// The link of a face, or NO_LINK where there is none to leave by. Such a walk reads face 0 instead: a load that all
// lanes do, and no word behind the last tet.
KERNEL_FN uint link_beyond(SceneView scene, uint tet, uint face)
{
    uint link = face_link(scene, tet, face & 3u);
    return face == NO_EXIT ? NO_LINK : link;
}

// Only the loop's own variables live on after it; everything else is loaded again (some compilers lose the rest).
KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint face = 0u;
    if (tet == NO_TET) {
        uint entry = entry_link(scene, ray);
        if (entry == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        face = exit_face(scene, tet, entry & 3u, ray);
    } else {
        face = start_face(scene, tet, ray);
    }
    uint link = link_beyond(scene, tet, face);
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    while (triangle == FREE_FACE && link != NO_LINK && steps < params.max_steps) {
        tet = link >> 2u;
        face = exit_face(scene, tet, link & 3u, ray);
        link = link_beyond(scene, tet, face);
        triangle = face_triangle(scene, tet, face & 3u);
        steps++;
    }
    if (face == NO_EXIT) return make_no_hit(LOST, tet, steps - 1u);
    uint hit_triangle = face_triangle(scene, tet, face);
    if (hit_triangle != FREE_FACE) return hit_on(scene, ray, hit_triangle, tet, steps);
    bool left = face_link(scene, tet, face) == NO_LINK;
    return make_no_hit(left ? NO_HIT : LOST, tet, steps);
}
