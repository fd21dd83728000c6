// The walk from tet to tet. A method brings exit_face() and start_face(), which return a face of the tet, or NO_EXIT.
// One that defines WALKS_PATHS always finds a face to go on by, and brings rough_exit_face(), which returns TIE_AT |
// entry at a tie: exit_face() then decides behind the loop, so that the rare tie costs nothing where there is none, nor
// on devices that execute what is behind a condition whether a lane meets it or not.
#ifdef WALKS_PATHS
#define EXIT_IN_LOOP rough_exit_face
#else
#define EXIT_IN_LOOP exit_face
#endif

// The link of a face, or NO_LINK where there is none to leave by, or none yet. Such a walk reads another face instead:
// a load that all lanes do, and no word behind the last tet.
KERNEL_FN uint link_beyond(SceneView scene, uint tet, uint face)
{
    uint link = face_link(scene, tet, face & 3u);
    return face >= NO_EXIT ? NO_LINK : link;
}

// Whether the ray has ended before it enters the tet that the link names: all three vertices of the face lie beyond
// its end along its direction. Rounding decides little: hits beyond the end are none anyway.
KERNEL_FN bool ends_before(SceneView scene, uint link, Ray ray, real end)
{
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    uint tet = link >> 2u;
    uint face = link & 3u;
    if (dot3(sub3(vertex(scene, tet, corner(face, 0u)), ray.origin), ray.direction) <= reach) return false;
    if (dot3(sub3(vertex(scene, tet, corner(face, 1u)), ray.origin), ray.direction) <= reach) return false;
    return dot3(sub3(vertex(scene, tet, corner(face, 2u)), ray.origin), ray.direction) > reach;
}

// What a walk has come to that has left so many tets, the last by this face.
KERNEL_FN Hit hit_at_end(SceneView scene, TraceParams params, Ray ray, uint tet, uint face, uint steps, real end)
{
    uint hit_triangle = face_triangle(scene, tet, face);
    if (hit_triangle != FREE_FACE) return hit_on(scene, ray, hit_triangle, tet, steps, end);
    bool left = face_link(scene, tet, face) == NO_LINK;
    bool ended = end < real(NO_END) && steps < params.max_steps;
    return make_no_hit(left || ended ? NO_HIT : LOST, tet, steps);
}

#ifdef WALKS_PATHS
// From a tet and the face by which the ray leaves it to the ray's hit. end: ray parameter that a hit has at most;
// NO_END of a ray without one. start: the triangle that a ray from inside starts on, or FREE_FACE; FROM_OUTSIDE of
// others. A ray from inside begins by exit_ahead() where first_face is NO_EXIT, and where it is lost in circles.
// Only the loops' own variables live on after them; everything else is loaded again (some compilers lose the rest).
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, uint first_tet, uint first_face, uint start, real end)
{
    bool is_endless = end >= real(NO_END);
    bool has_exit = start == FROM_OUTSIDE || first_face != NO_EXIT;
    uint own = has_exit ? (first_tet << 2u) | first_face : NO_LINK;
    bool may_begin_anew = start != FROM_OUTSIDE;
    uint tet = first_tet;
    uint face = has_exit ? first_face : 0u;
    uint link = has_exit ? link_beyond(scene, tet, face) : NO_LINK;
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    for (;;) {
        for (;;) {
            while (triangle == FREE_FACE && link != NO_LINK && steps < params.max_steps &&
                   (is_endless || !ends_before(scene, link, ray, end))) {
                tet = link >> 2u;
                face = EXIT_IN_LOOP(scene, tet, link & 3u, ray);
                link = link_beyond(scene, tet, face);
                triangle = face_triangle(scene, tet, face & 3u);
                steps++;
            }
            if (face < TIE_AT) break;
            face = exit_face(scene, tet, face & 3u, ray);
            link = face_link(scene, tet, face);
            triangle = face_triangle(scene, tet, face);
        }
        bool is_lost = steps >= params.max_steps && link != NO_LINK && triangle == FREE_FACE;
        if (!may_begin_anew || (own != NO_LINK && !is_lost)) break;
        uint exit = exit_ahead(scene, params, ray, start, own);
        if (exit == own && own != NO_LINK) break;
        tet = exit >> 2u;
        if (exit == NO_LINK) break;
        face = exit & 3u;
        link = face_link(scene, tet, face);
        triangle = face_triangle(scene, tet, face);
        steps = 1u;
        may_begin_anew = false;
    }
    if (tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    return hit_at_end(scene, params, ray, tet, face, steps, end);
}

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint face = 0u;
    uint start = FREE_FACE;
    if (tet == NO_TET) {
        uint entry = entry_link(scene, ray);
        if (entry == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        face = EXIT_IN_LOOP(scene, tet, entry & 3u, ray);
        start = FROM_OUTSIDE;
    } else {
        face = start_face(scene, tet, ray);
    }
    return walk(scene, params, ray, tet, face, start, real(NO_END));
}

// A ray that is given starts on the face that its link names, on the side of that tet: a method never leaves by the
// face that it entered by, so that the surface a ray starts on is not hit again. One that walks paths asks whether the
// face is on its path.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    uint link = direction.w;
    if (link == NO_LINK) link = entry_link(scene, ray);
    if (link == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
    Exit exit = exit_from_face(scene, ray, link);
    if (exit.tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint start = face_triangle(scene, link >> 2u, link & 3u);
    return walk(scene, params, ray, exit.tet, exit.face, start, as_real(origin.w));
}
#else
// From a tet and the face by which the ray leaves it to the ray's hit. end: ray parameter that a hit has at most;
// NO_END of a ray without one.
// Only the loop's own variables live on after it; everything else is loaded again (some compilers lose the rest).
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, uint first_tet, uint first_face, real end)
{
    bool is_endless = end >= real(NO_END);
    uint tet = first_tet;
    uint face = first_face;
    uint link = link_beyond(scene, tet, face);
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    while (triangle == FREE_FACE && link != NO_LINK && steps < params.max_steps &&
           (is_endless || !ends_before(scene, link, ray, end))) {
        tet = link >> 2u;
        face = EXIT_IN_LOOP(scene, tet, link & 3u, ray);
        link = link_beyond(scene, tet, face);
        triangle = face_triangle(scene, tet, face & 3u);
        steps++;
    }
    if (face == NO_EXIT) return make_no_hit(LOST, tet, steps - 1u);
    return hit_at_end(scene, params, ray, tet, face, steps, end);
}

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint face = 0u;
    if (tet == NO_TET) {
        uint entry = entry_link(scene, ray);
        if (entry == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        face = EXIT_IN_LOOP(scene, tet, entry & 3u, ray);
    } else {
        face = start_face(scene, tet, ray);
    }
    return walk(scene, params, ray, tet, face, real(NO_END));
}

// A ray that is given starts on the face that its link names, on the side of that tet: a method never leaves by the
// face that it entered by, so that the surface a ray starts on is not hit again.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    uint link = direction.w;
    if (link == NO_LINK) link = entry_link(scene, ray);
    if (link == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint face = exit_face(scene, link >> 2u, link & 3u, ray);
    return walk(scene, params, ray, link >> 2u, face, as_real(origin.w));
}
#endif

#undef EXIT_IN_LOOP
