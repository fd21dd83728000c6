// Where the lanes of a packet begin: entry.h and start_face() of project.h, lane by lane.

// entry_square() of entry.h; 6 n^2 for lanes that miss the domain.
LANE_FN Words entry_squares(const PacketJob& job, const Packet& packet)
{
    const uint n = job.divisions;
    Words squares = all(6 * n * n);
    for (uint axis = 0; axis < 3; axis++) {
        const uint across[2] = {axis == 2 ? 0 : axis + 1, axis == 0 ? 2 : axis - 1};
        const float* const planes = job.lines + axis * (n + 1);
        const bool from_high = planes[n] < job.origin[axis];
        if (!from_high && !(planes[0] > job.origin[axis])) continue;
        const float gap = from_high ? job.origin[axis] - planes[n] : planes[0] - job.origin[axis];
        const Floats direction = packet.direction[axis], slope = magnitude(direction);
        Mask met = from_high ? greater(Floats{}, direction) : greater(direction, Floats{});
        Words index[2]{};
        for (uint i = 0; i < 2; i++) {
            const float* const lines = job.lines + across[i] * (n + 1);
            const float origin = job.origin[across[i]];
            const Floats along = packet.direction[across[i]], reach = all(gap) * along;
            const Floats first = all(lines[0] - origin) * slope, last = all(lines[n] - origin) * slope;
            met = met & (greater(reach, first) | (equal(reach, first) & greater(along, Floats{})));
            met = met & (greater(last, reach) | (equal(last, reach) & greater(Floats{}, along)));
            if (lanes_of(met) == 0) break;
            for (uint line = 1; line < n; line++)
                index[i] = select(greater(all(lines[line] - origin) * slope, reach), index[i], index[i] + all(1u));
        }
        squares = select(met, (all((2 * axis + (from_high ? 1u : 0u)) * n) + index[1]) * n + index[0], squares);
    }
    return squares;
}

// The lanes that enter the domain by a boundary face; `left_to_scalar` gets those for which a sign is a tie.
template <int z>
LANE_FN uint lanes_entering(const PacketJob& job, Packet& packet, const Walk<z>& walk, uint lanes, uint link)
{
    Seen corners[3];
    for (uint i = 0; i < 3; i++)
        corners[i] = apex_seen(job, packet, walk.shear, (link & ~3u) | corner(link & 3u, i));
    const Sides s0 = sides_of(corners[0], corners[1]), s1 = sides_of(corners[1], corners[2]),
                s2 = sides_of(corners[2], corners[0]);
    const uint inside = lanes & lanes_of((s0.left | s0.tie) & (s1.left | s1.tie) & (s2.left | s2.tie));
    const uint ties = inside & lanes_of(s0.tie | s1.tie | s2.tie);
    packet.left_to_scalar |= ties;
    return inside & ~ties;
}

// From outside: lanes of one square together, face after face of it.
template <int z>
[[gnu::noinline]] void enter_domain(const PacketJob& job, Packet& packet, Walk<z>& walk, uint lanes)
{
    const Words squares = entry_squares(job, packet);
    LaneWords square;
    store(square, squares);
    lanes &= ~lanes_of(equal(squares, all(6 * job.divisions * job.divisions)));
    while (lanes != 0) {
        const uint here = square.of[first_of(lanes)];
        uint waiting = lanes & lanes_of(equal(squares, all(here)));
        lanes &= ~waiting;
        for (uint i = job.entry_ranges[here]; waiting != 0 && i < job.entry_ranges[here + 1]; i++) {
            const uint link = job.entry_links[i];
            const uint entering = lanes_entering(job, packet, walk, waiting, link);
            if (entering != 0) enter_record(job, packet, walk, entering, link);
            waiting &= ~(entering | packet.left_to_scalar);
        }
        packet.left_to_scalar |= waiting; // those that entry_anywhere() is for
    }
}

// exit_through() of half32.h.
LANE_FN uint exit_through(const PacketJob& job, uint tet, uint face)
{
    const std::size_t record = 4 * std::size_t{tet} + (face == 0 ? 1 : 0);
    return job.records[4 * (HALF32_ROWS * record + 1) + (face <= 1 ? 0 : face - 1)];
}

// Lets lanes leave the tet that they start in by one of its faces.
template <int z>
LANE_FN void leave_first(const PacketJob& job, Packet& packet, Walk<z>& walk, uint lanes, uint face)
{
    if (lanes == 0) return;
    const uint exit = exit_through(job, job.start_tet, face);
    if ((exit & 3u) == HALF32_END)
        end_lanes(packet, lanes, all(exit), all(job.start_tet << 2), 1);
    else
        enter_record(job, packet, walk, lanes, exit >> 2);
}

// face_left_by() of signs.h: the lanes that leave a tet by each of its faces. ties: those with a sign that is one.
struct ByFace {
    uint of[4], ties;
};
LANE_FN ByFace by_face_left(const Seen* v)
{
    const Sides s01 = sides_of(v[0], v[1]), s02 = sides_of(v[0], v[2]), s03 = sides_of(v[0], v[3]),
                s12 = sides_of(v[1], v[2]), s13 = sides_of(v[1], v[3]), s23 = sides_of(v[2], v[3]);
    return {{lanes_of(without(without(s13.left, s12.left), s23.left)), lanes_of(without(s23.left & s02.left, s03.left)),
             lanes_of(without(without(s03.left, s01.left), s13.left)),
             lanes_of(without(s12.left & s01.left, s02.left))},
            lanes_of(s01.tie | s02.tie | s03.tie | s12.tie | s13.tie | s23.tie)};
}

// From inside: start_face() of project.h.
template <int z>
[[gnu::noinline]] void leave_start(const PacketJob& job, Packet& packet, Walk<z>& walk, uint lanes)
{
    Seen v[4];
    for (uint i = 0; i < 4; i++)
        v[i] = apex_seen(job, packet, walk.shear, job.start_tet << 2 | i);
    const ByFace left = by_face_left(v);
    uint waiting = lanes & ~left.ties;
    for (uint face = 0; face < 4; face++) {
        leave_first(job, packet, walk, waiting & left.of[face], face);
        waiting &= ~left.of[face];
    }
    packet.left_to_scalar |= (lanes & left.ties) | waiting;
}
