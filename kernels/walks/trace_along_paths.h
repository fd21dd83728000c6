// From a ray to its walk along its path. Include after a file that defines Beginning, BEGINNING_AT, BEGINNING_IN and
// walk().
KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    Shear shear = shear_of(ray);
    Beginning first;
    uint start = params.start_tet == NO_TET ? FROM_OUTSIDE : FREE_FACE; // here a compiler sees that it is constant
    if (params.start_tet == NO_TET) {
        Entrance entrance = entrance_of(scene, ray, shear);
        uint link = entry_link(scene, entrance.index);
        if (link == NO_LINK) return make_no_hit(entrance.index == LEFT ? LEFT : NO_HIT, NO_TET, 0u);
        first = BEGINNING_AT(scene, ray, link, entrance);
    } else {
        first = BEGINNING_IN(scene, ray, shear, params.start_tet, start_face(scene, params.start_tet, ray));
    }
    return walk(scene, params, ray, first, start, real(NO_END));
}

// A given ray starts on the face that its link names, on the side of that tet. exit_from_face() tests whether that face
// is on the ray's path, so the surface that a ray starts on is not hit again.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    Shear shear = shear_of(ray);
    uint link = direction.w;
    if (link == NO_LINK) link = entry_link(scene, entrance_of(scene, ray, shear).index);
    if (link == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
    Exit exit = exit_from_face(scene, ray, link);
    if (exit.tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint start = face_triangle(scene, link >> 2u, link & 3u);
    Beginning first = BEGINNING_IN(scene, ray, shear, exit.tet, exit.face);
    return walk(scene, params, ray, first, start, as_real(origin.w));
}
