// The walk from tet to tet along a ray's path, for methods that define WALKS_PATHS, which always find an exit. Such a
// method defines rough_exit_face(), which returns TIE_AT | entry at a tie; exit_face() then decides after the loop.
// Ties are rare, and steps without one pay nothing for them, even on devices that execute a conditional block although
// no lane needs it.

// How a walk begins.
#define Beginning Exit

// By a boundary face, the one that the link names.
#define BEGINNING_AT(scene, ray, link, entrance)                                                                       \
    beginning_in((link) >> 2u, rough_exit_face(scene, (link) >> 2u, (link)&3u, ray))

// In a tet that the ray leaves by `face`, or by NO_EXIT.
#define BEGINNING_IN(scene, ray, shear, tet, face) beginning_in(tet, face)
KERNEL_FN Beginning beginning_in(uint tet, uint face)
{
    Beginning first;
    first.tet = tet;
    first.face = face;
    return first;
}

// From its beginning to the ray's hit. end: the largest ray parameter of a hit; NO_END
// for a ray without an end. start: the triangle that a ray from inside starts on, or FREE_FACE; FROM_OUTSIDE for a ray
// from outside. A ray from inside begins with exit_ahead() if its first face is NO_EXIT, and again if its walk goes in
// circles, which it asks once, after STEPS_BEFORE_DOUBT steps.
// Only the loops' own variables are used after the loops; everything else is loaded again, because some compilers lose
// it.
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, Beginning first, uint start, real end)
{
    bool is_endless = end >= real(NO_END);
    bool has_exit = start == FROM_OUTSIDE || first.face != NO_EXIT;
    uint own = has_exit ? (first.tet << 2u) | first.face : NO_LINK;
    bool may_begin_anew = start != FROM_OUTSIDE;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    uint tet = first.tet;
    uint face = has_exit ? first.face : 0u;
    uint link = has_exit ? link_beyond(scene, tet, face) : NO_LINK;
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    for (;;) {
        for (;;) {
            while (triangle == FREE_FACE && link != NO_LINK && steps < pause &&
                   (is_endless || !ends_before(scene, link, ray, end))) {
                tet = link >> 2u;
                face = rough_exit_face(scene, tet, link & 3u, ray);
                link = link_beyond(scene, tet, face);
                triangle = face_triangle(scene, tet, face & 3u);
                ++steps;
            }
            if (LEAVES_TIES || face < TIE_AT) break;
            face = exit_face(scene, tet, face & 3u, ray);
            link = face_link(scene, tet, face);
            triangle = face_triangle(scene, tet, face);
        }
        bool is_paused = steps >= pause && link != NO_LINK && triangle == FREE_FACE;
        if (!may_begin_anew || (own != NO_LINK && !is_paused)) break;
        uint exit = exit_ahead(scene, params, ray, start, own);
        pause = params.max_steps;
        may_begin_anew = false;
        tet = exit >> 2u;
        if (exit == NO_LINK) break;
        face = exit & 3u;
        link = face_link(scene, tet, face);
        triangle = face_triangle(scene, tet, face);
        steps = 1u;
    }
    if (LEAVES_TIES && face >= TIE_AT) return make_no_hit(LEFT, tet, steps);
    if (tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    return hit_at_end(scene, params, ray, tet, face, steps, end);
}
