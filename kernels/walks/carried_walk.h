// The walk of project through records (half32.h): the three vertices of the face that the ray has entered by are
// carried as the ray sees them, and a step projects one new vertex. Decisions, and so the bits of its hits, are those
// of walk.h on tets that hold their vertices (docs/spec/layouts.md, L4).

// A vertex of the entry face: a number for the order that decides ties is all that is left of its place.
STRUCT(Carried)
{
    Sheared seen;
    uint rank;
    real along; // its depth, as ends_before() of walk.h has it: of no use to rays without an end
};

KERNEL_FN Carried carried(Ray ray, Shear shear, uint4 apex)
{
    Vec3 offset = sub3(VEC3(as_real(apex.x), as_real(apex.y), as_real(apex.z)), ray.origin);
    Carried result;
    result.seen = sheared(shear, offset);
    result.rank = apex.w;
    result.along = dot3(offset, ray.direction);
    return result;
}

// is_left() of signs.h, where ranks tell the order.
KERNEL_FN bool carried_is_left(Carried p, Carried q)
{
    PRECISE real plus = p.seen.x * q.seen.y;
    PRECISE real minus = p.seen.y * q.seen.x;
    if (plus == minus) return SIDE_AT_TIE(p.seen, q.seen, p.rank < q.rank, plus);
    COUNT_SIGN(0);
    return plus > minus;
}

// What lies behind a face of the tet that a walk begins in, as an exit of a record that fetches its corners anew.
KERNEL_FN uint first_exit(SceneView scene, uint tet, uint face)
{
    uint exit = exit_through(scene, tet, face);
    return (exit & 3u) == HALF32_END ? exit : exit & ~3u;
}

// Record of a face's corner: that which has it as its apex.
KERNEL_FN uint record_of_corner(uint link, uint index)
{
    return (link & ~3u) | corner(link & 3u, index);
}

// Which of the entry face's vertices the ray leaves behind: the exit face has the apex in its place.
KERNEL_FN uint left_behind(Carried p0, Carried p1, Carried p2, Carried apex)
{
    bool left = carried_is_left(p2, apex);
    bool other_left = carried_is_left(left ? p1 : p0, apex);
    return other_left ? (left ? 2u : 1u) : (left ? 0u : 2u);
}

// The same where float products decide; UNDECIDED at a tie.
#define UNDECIDED 3u
KERNEL_FN uint roughly_left_behind(Sheared p0, Sheared p1, Sheared p2, Sheared apex)
{
    PRECISE real plus = p2.x * apex.y;
    PRECISE real minus = p2.y * apex.x;
    bool left = plus > minus;
    PRECISE real other_plus = (left ? p1.x : p0.x) * apex.y;
    PRECISE real other_minus = (left ? p1.y : p0.y) * apex.x;
    uint behind = other_plus > other_minus ? (left ? 2u : 1u) : (left ? 0u : 2u);
    return plus == minus || other_plus == other_minus ? UNDECIDED : behind;
}

// How far a ray has come: the face that it is at, and what is behind it.
STRUCT(Walker)
{
    Carried p0;
    Carried p1;
    Carried p2;
    uint turn;   // corner i of the face, as the record before it has them, is the carried vertex (i + turn) % 3
    uint exit;   // of that record
    uint record; // whichever of its tet's
    uint steps;
};

// reach: of the end, as ends_before() of walk.h has it.
KERNEL_FN bool goes_on(Walker at, TraceParams params, bool is_endless, real reach)
{
    return (at.exit & 3u) != HALF32_END && at.steps < params.max_steps &&
           (is_endless || at.p0.along <= reach || at.p1.along <= reach || at.p2.along <= reach);
}

// The face by which the ray leaves the tet behind this one.
KERNEL_FN Walker next_face(Walker at, Carried apex, uint4 exits, uint behind)
{
    Walker next;
    next.p0 = behind == 0u ? apex : at.p0;
    next.p1 = behind == 1u ? apex : at.p1;
    next.p2 = behind == 2u ? apex : at.p2;
    uint turn = at.turn + (at.exit & 3u);
    next.turn = turn >= 3u ? turn - 3u : turn;
    uint index = behind < next.turn ? behind + 3u - next.turn : behind - next.turn;
    next.exit = index == 0u ? exits.x : index == 1u ? exits.y : exits.z;
    next.record = at.exit >> 2u;
    next.steps = at.steps + 1u;
    return next;
}

// At an exit of `tet`, left in so many steps.
KERNEL_FN Walker walker_at(SceneView scene, Ray ray, Shear shear, uint tet, uint exit, uint steps)
{
    uint first = (exit & 3u) == HALF32_END ? tet << 2u : exit >> 2u;
    Walker at;
    at.p0 = carried(ray, shear, record_apex(scene, record_of_corner(first, 0u)));
    at.p1 = carried(ray, shear, record_apex(scene, record_of_corner(first, 1u)));
    at.p2 = carried(ray, shear, record_apex(scene, record_of_corner(first, 2u)));
    at.turn = 0u;
    at.exit = exit;
    at.record = tet << 2u;
    at.steps = steps;
    return at;
}

// From a face of a tet to the ray's hit: that by which the ray leaves it, or enters it where start is FROM_OUTSIDE.
// start, end, and where a walk begins by exit_ahead(): as in walk.h. Loops ask at their end, and ties are decided
// behind the inner one: some devices execute what is behind a condition whether a lane meets it or not
// (docs/spec/devices.md, W1).
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, uint first_tet, uint face, uint start, real end)
{
    bool is_endless = end >= real(NO_END);
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    Shear shear = shear_of(ray);
    bool may_begin_anew = start != FROM_OUTSIDE;
    uint own = face == NO_EXIT ? NO_LINK : (first_tet << 2u) | face;
    uint tet = first_tet;
    uint exit = own << 2u;
    if (may_begin_anew) exit = own == NO_LINK ? NO_LINK : first_exit(scene, tet, face);
    uint steps = may_begin_anew ? 1u : 0u;
    Walker at;
    for (;;) {
        at = walker_at(scene, ray, shear, tet, exit, steps);
        if (goes_on(at, params, is_endless, reach)) {
            for (;;) {
                for (;;) {
                    Carried apex = carried(ray, shear, record_apex(scene, at.exit >> 2u));
                    uint4 exits = record_exits(scene, at.exit >> 2u);
                    uint behind = roughly_left_behind(at.p0.seen, at.p1.seen, at.p2.seen, apex.seen);
                    if (behind == UNDECIDED) break;
                    at = next_face(at, apex, exits, behind);
                    if (!goes_on(at, params, is_endless, reach)) break;
                }
                if (!goes_on(at, params, is_endless, reach)) break;
                Carried apex = carried(ray, shear, record_apex(scene, at.exit >> 2u));
                uint4 exits = record_exits(scene, at.exit >> 2u);
                at = next_face(at, apex, exits, left_behind(at.p0, at.p1, at.p2, apex));
                if (!goes_on(at, params, is_endless, reach)) break;
            }
        }
        bool is_lost = (at.exit & 3u) != HALF32_END && at.steps >= params.max_steps;
        if (!may_begin_anew || (own != NO_LINK && !is_lost)) break;
        uint ahead = exit_ahead(scene, params, ray, start, own);
        if (ahead == own && own != NO_LINK) break;
        tet = ahead >> 2u;
        if (ahead == NO_LINK) break;
        exit = first_exit(scene, tet, ahead & 3u);
        may_begin_anew = false;
    }
    if (tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    tet = at.record >> 2u;
    if (at.exit == NO_LINK) return make_no_hit(NO_HIT, tet, at.steps);
    if ((at.exit & 3u) == HALF32_END) return hit_on(scene, ray, at.exit >> 2u, tet, at.steps, end);
    return make_no_hit(!is_endless && at.steps < params.max_steps ? NO_HIT : LOST, tet, at.steps);
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
        face = entry & 3u;
        start = FROM_OUTSIDE;
    } else {
        face = start_face(scene, tet, ray);
    }
    return walk(scene, params, ray, tet, face, start, real(NO_END));
}

// As in walk.h.
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
