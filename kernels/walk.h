// The walk from tet to tet. A method brings exit_face() and start_face(), which return a face of the tet, or NO_EXIT.
// One that defines HAS_TIES always finds a face to go on by, and brings rough_exit_face(), which returns TIE_AT | entry
// at a tie: exit_face() then decides behind the loop, so that the rare tie costs nothing where there is none, nor on
// devices that execute what is behind a condition whether a lane meets it or not.
#ifdef HAS_TIES
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
#ifdef HAS_TIES
    for (;;) {
#endif
        while (triangle == FREE_FACE && link != NO_LINK && steps < params.max_steps &&
               (is_endless || !ends_before(scene, link, ray, end))) {
            tet = link >> 2u;
            face = EXIT_IN_LOOP(scene, tet, link & 3u, ray);
            link = link_beyond(scene, tet, face);
            triangle = face_triangle(scene, tet, face & 3u);
            steps++;
        }
#ifdef HAS_TIES
        if (face < TIE_AT) break;
        face = exit_face(scene, tet, face & 3u, ray);
        link = face_link(scene, tet, face);
        triangle = face_triangle(scene, tet, face);
    }
#endif
    if (face == NO_EXIT) return make_no_hit(LOST, tet, steps - 1u);
    uint hit_triangle = face_triangle(scene, tet, face);
    if (hit_triangle != FREE_FACE) return hit_on(scene, ray, hit_triangle, tet, steps, end);
    bool left = face_link(scene, tet, face) == NO_LINK;
    bool ended = !is_endless && steps < params.max_steps;
    return make_no_hit(left || ended ? NO_HIT : LOST, tet, steps);
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
#ifdef WALKS_PATHS
        if (face == NO_EXIT) {
            uint exit = exit_ahead(scene, params, ray, FREE_FACE);
            if (exit == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
            tet = exit >> 2u;
            face = exit & 3u;
        }
#endif
    }
    return walk(scene, params, ray, tet, face, real(NO_END));
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
#ifdef WALKS_PATHS
    link = exit_from_face(scene, params, ray, link);
    if (link == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint face = link & 3u;
#else
    uint face = exit_face(scene, link >> 2u, link & 3u, ray);
#endif
    return walk(scene, params, ray, link >> 2u, face, as_real(origin.w));
}

#undef EXIT_IN_LOOP
