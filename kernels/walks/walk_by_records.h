// The walk of project through records (half32.h): it carries the vertices of the current face. Decisions, and so the
// bits of the hits, are the same as in walk_along_paths.h on tets that hold their vertices (docs/spec/layouts.md, L4).

// What lies behind a face of the tet in which a walk begins, as a record's exit without a rotation: the corners are
// then fetched from memory.
KERNEL_FN uint first_exit(SceneView scene, uint tet, uint face)
{
    uint exit = exit_through(scene, tet, face);
    return (exit & 3u) == HALF32_END ? exit : exit & ~3u;
}

// Record of a face's corner: the record whose apex it is.
KERNEL_FN uint record_of_corner(uint link, uint index)
{
    return (link & ~3u) | corner(link & 3u, index);
}

// Instead of an exit that is not yet known. It ends the loop as the end of a walk does; no triangle has this number.
#define EXIT_AT_TIE ((HALF32_MAX_TRIANGLES << 2u) | HALF32_END)

// The state of a walk: the current face, and what is behind it.
STRUCT(Walker)
{
    Carried p0;
    Carried p1;
    Carried p2;
    uint turn;   // corner i of the previous record's entry face is the carried vertex (i + turn) % 3
    uint exit;   // of that record, or EXIT_AT_TIE
    uint before; // the exit that led to that record
    uint steps;
};

// pause: the number of steps at which the walk halts. reach: of the end, as ends_before() of links.h has it.
KERNEL_FN bool goes_on(Walker at, uint pause, bool is_endless, real reach)
{
    return (at.exit & 3u) != HALF32_END && at.steps < pause &&
           (is_endless || at.p0.along <= reach || at.p1.along <= reach || at.p2.along <= reach);
}

// The walker with the apex of its previous record in place of a carried vertex, at the exit that this leads to.
KERNEL_FN Walker with_apex(Walker at, Carried apex, uint4 exits, uint replaced)
{
    Walker next = at;
    next.p0 = replaced == 0u ? apex : at.p0;
    next.p1 = replaced == 1u ? apex : at.p1;
    next.p2 = replaced == 2u ? apex : at.p2;
    uint index = replaced < at.turn ? replaced + 3u - at.turn : replaced - at.turn;
    uint exit = index == 0u ? exits.x : index == 1u ? exits.y : exits.z;
    next.exit = replaced == UNDECIDED ? EXIT_AT_TIE : exit;
    return next;
}

// The face by which the ray leaves the tet behind the current face, as far as float products tell. One branch ends the
// loop around it: nothing waits for the record's second half alone.
KERNEL_FN Walker next_face(SceneView scene, Ray ray, Shear shear, Walker at)
{
    Carried apex = carried(ray, shear, record_apex(scene, at.exit >> 2u));
    uint4 exits = record_exits(scene, at.exit >> 2u);
    Walker next = at;
    uint turn = at.turn + (at.exit & 3u);
    next.turn = turn >= 3u ? turn - 3u : turn;
    next.before = at.exit;
    next.steps = at.steps + 1u;
    return with_apex(next, apex, exits, roughly_replaced_by(at.p0.seen, at.p1.seen, at.p2.seen, apex.seen));
}

// The same at a tie, which the step to `at` has left undecided.
KERNEL_FN Walker face_at_tie(SceneView scene, Ray ray, Shear shear, Walker at)
{
    uint record = at.before >> 2u;
    uint rank_0 = record_apex(scene, record_of_corner(record, 0u)).w;
    uint rank_1 = record_apex(scene, record_of_corner(record, 1u)).w;
    uint rank_2 = record_apex(scene, record_of_corner(record, 2u)).w;
    Ranks ranks;
    ranks.p0 = at.turn == 0u ? rank_0 : at.turn == 1u ? rank_2 : rank_1;
    ranks.p1 = at.turn == 0u ? rank_1 : at.turn == 1u ? rank_0 : rank_2;
    ranks.p2 = at.turn == 0u ? rank_2 : at.turn == 1u ? rank_1 : rank_0;
    uint4 vertex = record_apex(scene, record);
    Carried apex = carried(ray, shear, vertex);
    uint replaced = replaced_by(at.p0.seen, at.p1.seen, at.p2.seen, ranks, apex.seen, vertex.w);
    return with_apex(at, apex, record_exits(scene, record), replaced);
}

// A walk at an exit of `tet`, after it has left `steps` tets.
KERNEL_FN Walker walker_with(Carried p0, Carried p1, Carried p2, uint tet, uint exit, uint steps)
{
    Walker at;
    at.p0 = p0;
    at.p1 = p1;
    at.p2 = p2;
    at.turn = 0u;
    at.exit = exit;
    at.before = tet << 4u;
    at.steps = steps;
    return at;
}

// The walk at the face by which it leaves a tet, its first.
KERNEL_FN Walker walker_leaving(SceneView scene, Ray ray, Shear shear, uint tet, uint face)
{
    uint exit = first_exit(scene, tet, face);
    uint record = (exit & 3u) == HALF32_END ? tet << 2u : exit >> 2u;
    return walker_with(carried(ray, shear, record_apex(scene, record_of_corner(record, 0u))),
                       carried(ray, shear, record_apex(scene, record_of_corner(record, 1u))),
                       carried(ray, shear, record_apex(scene, record_of_corner(record, 2u))), tet, exit, 1u);
}

// How a walk begins.
STRUCT(Beginning)
{
    Walker at;
    uint own; // the face by which the ray leaves its first tet, as tet << 2 | face; NO_LINK where there is none
};

// By a boundary face, the one that the link names.
#define BEGINNING_AT(scene, ray, link, entrance) beginning_at(link, entrance)
KERNEL_FN Beginning beginning_at(uint link, Entrance entrance)
{
    Beginning first;
    first.at = walker_with(carried_from(entrance.p0), carried_from(entrance.p1), carried_from(entrance.p2), link >> 2u,
                           link << 2u, 0u);
    first.own = link;
    return first;
}

// In a tet that the ray leaves by `face`, or by NO_EXIT.
#define BEGINNING_IN(scene, ray, shear, tet, face) beginning_in(scene, ray, shear, tet, face)
KERNEL_FN Beginning beginning_in(SceneView scene, Ray ray, Shear shear, uint tet, uint face)
{
    Beginning first;
    first.at = walker_leaving(scene, ray, shear, tet, face & 3u);
    first.own = (tet << 2u) | face;
    if (face == NO_EXIT) first.at.exit = NO_LINK;
    if (face == NO_EXIT) first.own = NO_LINK;
    return first;
}

// From its beginning to the ray's hit. start, end and the use of exit_ahead(): as in walk_along_paths.h. Loops test at
// their end, and ties are decided after the inner loop: some devices execute a conditional block even if no lane needs
// it (docs/spec/devices.md, W1).
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, Beginning first, uint start, real end)
{
    Shear shear = shear_of(ray);
    bool is_endless = end >= real(NO_END);
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    bool may_begin_anew = start != FROM_OUTSIDE;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    Walker at = first.at;
    for (;;) {
        if (goes_on(at, pause, is_endless, reach)) {
            for (;;) {
                for (;;) {
                    at = next_face(scene, ray, shear, at);
                    if (!goes_on(at, pause, is_endless, reach)) break;
                }
                if (LEAVES_TIES || at.exit != EXIT_AT_TIE) break;
                at = face_at_tie(scene, ray, shear, at);
                if (!goes_on(at, pause, is_endless, reach)) break;
            }
        }
        bool is_paused = (at.exit & 3u) != HALF32_END && at.steps >= pause;
        if (!may_begin_anew || (first.own != NO_LINK && !is_paused)) break;
        uint ahead = exit_ahead(scene, params, ray, start, first.own);
        pause = params.max_steps;
        may_begin_anew = false;
        if (ahead == NO_LINK) at.steps = 0u;
        if (ahead == NO_LINK) break;
        at = walker_leaving(scene, ray, shear, ahead >> 2u, ahead & 3u);
    }
    if (at.steps == 0u) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint tet = at.before >> 4u;
    if (at.exit == NO_LINK || (LEAVES_TIES && at.exit == EXIT_AT_TIE))
        return make_no_hit(at.exit == NO_LINK ? NO_HIT : LEFT, tet, at.steps);
    if ((at.exit & 3u) == HALF32_END) return hit_on(scene, ray, at.exit >> 2u, tet, at.steps, end);
    return make_no_hit(!is_endless && at.steps < params.max_steps ? NO_HIT : LOST, tet, at.steps);
}
