// From a ray to its walk along its path. Include after a file that defines walk() and FACE_AT_ENTRY(scene, tet, entry,
// ray): the face by which walk() begins for a ray that enters the domain by face `entry` of the tet.
KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint face = 0u;
    uint start = FREE_FACE;
    if (tet == NO_TET) {
        uint index = entry_index(scene, ray);
        uint entry = entry_link(scene, index);
        if (entry == NO_LINK) return make_no_hit(index == LEFT ? LEFT : NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        face = FACE_AT_ENTRY(scene, tet, entry & 3u, ray);
        start = FROM_OUTSIDE;
    } else {
        face = start_face(scene, tet, ray);
    }
    return walk(scene, params, ray, tet, face, start, real(NO_END));
}

// A given ray starts on the face that its link names, on the side of that tet. exit_from_face() tests whether that face
// is on the ray's path, so the surface that a ray starts on is not hit again.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    uint link = direction.w;
    if (link == NO_LINK) link = entry_link(scene, entry_index(scene, ray));
    if (link == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
    Exit exit = exit_from_face(scene, ray, link);
    if (exit.tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint start = face_triangle(scene, link >> 2u, link & 3u);
    return walk(scene, params, ray, exit.tet, exit.face, start, as_real(origin.w));
}
