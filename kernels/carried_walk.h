// The walk of project through records (half32.h): the three vertices of the face that the ray has entered by are
// carried as the ray sees them, and a step projects one new vertex. Decisions, and so the bits of its hits, are those
// of walk.h on tets that hold their vertices: SPEC.md, Carried vertices.

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
    if (carried_is_left(p2, apex)) return carried_is_left(p1, apex) ? 2u : 0u;
    return carried_is_left(p0, apex) ? 1u : 2u;
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

// From an exit of `tet`, left in so many steps, to the ray's hit. first_steps: 0 where the exit is the boundary face
// that the ray enters by, else 1. end: as in walk.h. Ties are decided between two runs of the inner loop: some devices
// execute what is behind a condition whether a lane meets it or not.
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, uint tet, uint first_exit, uint first_steps, real end)
{
    bool is_endless = end >= real(NO_END);
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    Shear shear = shear_of(ray);
    uint exit = first_exit;
    uint record = (exit & 3u) == HALF32_END ? tet << 2u : exit >> 2u;
    Carried p0 = carried(ray, shear, record_apex(scene, record_of_corner(record, 0u)));
    Carried p1 = carried(ray, shear, record_apex(scene, record_of_corner(record, 1u)));
    Carried p2 = carried(ray, shear, record_apex(scene, record_of_corner(record, 2u)));
    record = tet << 2u; // whose exit this is: any of its records
    uint turn = 0u;     // corner i of the entry face is the carried vertex (i + turn) % 3
    uint steps = first_steps;
    uint decided = UNDECIDED;
    bool goes_on = (exit & 3u) != HALF32_END && steps < params.max_steps &&
                   (is_endless || p0.along <= reach || p1.along <= reach || p2.along <= reach);
    while (goes_on) {
        bool is_tie = false;
        while (goes_on && !is_tie) {
            Carried apex = carried(ray, shear, record_apex(scene, exit >> 2u));
            uint4 exits = record_exits(scene, exit >> 2u);
            uint behind = roughly_left_behind(p0.seen, p1.seen, p2.seen, apex.seen);
            behind = decided == UNDECIDED ? behind : decided;
            decided = UNDECIDED;
            is_tie = behind == UNDECIDED;
            if (!is_tie) {
                record = exit >> 2u;
                turn += exit & 3u;
                turn = turn >= 3u ? turn - 3u : turn;
                p0 = behind == 0u ? apex : p0;
                p1 = behind == 1u ? apex : p1;
                p2 = behind == 2u ? apex : p2;
                uint index = behind < turn ? behind + 3u - turn : behind - turn;
                exit = index == 0u ? exits.x : index == 1u ? exits.y : exits.z;
                steps++;
            }
            goes_on = (exit & 3u) != HALF32_END && steps < params.max_steps &&
                      (is_endless || p0.along <= reach || p1.along <= reach || p2.along <= reach);
        }
        if (is_tie) decided = left_behind(p0, p1, p2, carried(ray, shear, record_apex(scene, exit >> 2u)));
    }
    tet = record >> 2u;
    if (exit == NO_LINK) return make_no_hit(NO_HIT, tet, steps);
    if ((exit & 3u) == HALF32_END) return hit_on(scene, ray, exit >> 2u, tet, steps, end);
    return make_no_hit(!is_endless && steps < params.max_steps ? NO_HIT : LOST, tet, steps);
}

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint exit = NO_LINK;
    uint steps = 0u;
    if (tet == NO_TET) {
        uint entry = entry_link(scene, ray);
        if (entry == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        exit = entry << 2u;
    } else {
        uint face = start_face(scene, tet, ray);
        uint ahead = face == NO_EXIT ? exit_ahead(scene, params, ray, FREE_FACE) : (tet << 2u) | face;
        if (ahead == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = ahead >> 2u;
        exit = first_exit(scene, tet, ahead & 3u);
        steps = 1u;
    }
    return walk(scene, params, ray, tet, exit, steps, real(NO_END));
}

// As in walk.h.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    uint link = direction.w;
    if (link == NO_LINK) link = entry_link(scene, ray);
    if (link != NO_LINK) link = exit_from_face(scene, params, ray, link);
    if (link == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint tet = link >> 2u;
    return walk(scene, params, ray, tet, first_exit(scene, tet, link & 3u), 1u, as_real(origin.w));
}
