// Where the lanes of a packet begin: entry.h and start_face() of project.h, lane by lane.

// The number that a lane's axis has among three.
LANE_FN Floats of_axis(const Mask* is_axis, uint turn, const Floats* of)
{
    const uint y = (1 + turn) % 3, z = (2 + turn) % 3;
    return select(is_axis[1], of[y], select(is_axis[2], of[z], of[turn]));
}

// entry_square() of entry_on_path.h; 6 n^2 for lanes that miss the domain.
LANE_FN Words entry_squares(const PacketJob& job, const Packet& packet)
{
    const uint n = job.divisions;
    Floats low[3], high[3], gap[3], rise[3];
    Words side_of[3];
    for (uint axis = 0; axis < 3; ++axis) {
        low[axis] = all(job.lines[axis * (n + 1)]);
        high[axis] = all(job.lines[axis * (n + 1) + n]);
        const Floats origin = packet.origin[axis], direction = packet.direction[axis];
        const Mask falls = greater(Floats{}, direction), rises = greater(direction, Floats{});
        const Floats distance = select(falls, origin - high[axis], select(rises, low[axis] - origin, Floats{}));
        gap[axis] = select(greater(distance, Floats{}), distance, Floats{});
        rise[axis] = magnitude(direction);
        side_of[axis] = all(2 * axis) + select(falls, all(1u), Words{});
    }
    // The last of the planes that is not met before another.
    Mask is_axis[3];
    for (uint axis = 0; axis < 3; ++axis) {
        is_axis[axis] = greater(gap[axis], Floats{});
        for (uint other = (axis + 1) % 3; other != axis; other = (other + 1) % 3)
            is_axis[axis] = without(is_axis[axis], greater(gap[other] * rise[axis], gap[axis] * rise[other]));
    }
    is_axis[1] = without(is_axis[1], is_axis[2]);
    is_axis[0] = without(without(is_axis[0], is_axis[1]), is_axis[2]);
    Mask met = is_axis[0] | is_axis[1] | is_axis[2];
    const Words side = select(is_axis[1], side_of[1], select(is_axis[2], side_of[2], side_of[0]));
    const Floats gap_met = of_axis(is_axis, 0, gap), slope = of_axis(is_axis, 0, rise);
    Words index[2];
    for (uint i = 0; i < 2; ++i) {
        const Floats origin = of_axis(is_axis, (1 + i) % 3, packet.origin);
        const Floats direction = of_axis(is_axis, (1 + i) % 3, packet.direction);
        const Floats reach = gap_met * direction;
        const Floats first = (of_axis(is_axis, (1 + i) % 3, low) - origin) * slope;
        const Floats last = (of_axis(is_axis, (1 + i) % 3, high) - origin) * slope;
        met = met & (greater(reach, first) | (equal(reach, first) & greater(direction, Floats{})));
        met = met & (greater(last, reach) | (equal(last, reach) & greater(Floats{}, direction)));
        const Floats place = (reach - first) * all(static_cast<float>(n)) / (last - first);
        const Floats inside = select(met & greater(place, Floats{}), place, Floats{});
        index[i] = least(reinterpret_cast<Words>(__builtin_convertvector(inside, Ints)), all(n - 1));
    }
    return select(met, (side * n + index[1]) * n + index[0], all(6 * n * n));
}

// The lanes that enter the domain by a boundary face, by its corners; `deferred` gets those for which a sign is a
// tie.
LANE_FN uint lanes_entering(Packet& packet, uint lanes, const Seen* corners)
{
    const Sides s0 = sides_of(corners[0], corners[1]), s1 = sides_of(corners[1], corners[2]),
                s2 = sides_of(corners[2], corners[0]);
    const uint inside = lanes & lanes_of((s0.left | s0.tie) & (s1.left | s1.tie) & (s2.left | s2.tie));
    const uint ties = inside & lanes_of(s0.tie | s1.tie | s2.tie);
    packet.deferred |= ties;
    return inside & ~ties;
}

// From outside: lanes of one square together, face by face.
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
        for (uint i = job.entry_ranges[here]; waiting != 0 && i < job.entry_ranges[here + 1]; ++i) {
            const uint half_face = job.entry_half_faces[i];
            Seen corners[3];
            for (uint corner_i = 0; corner_i < 3; ++corner_i)
                corners[corner_i] = apex_seen(job, packet, walk.shear, record_of_corner(half_face, corner_i));
            const uint entering = lanes_entering(packet, waiting, corners);
            if (entering != 0) enter_record(job, packet, walk, entering, half_face);
            waiting &= ~(entering | packet.deferred);
        }
        packet.deferred |= waiting; // lanes that need entry_anywhere()
    }
}

// Corner i of the faces that lanes' half-faces name.
LANE_FN Quad corners_of(const PacketJob& job, Words half_faces, uint i)
{
    LaneWords offsets;
    store(offsets, record_of_corner(half_faces, i) * (4 * HALF32_QUADS));
    return load_quads(job.records, offsets);
}

// Tests the faces of squares of the domain, one per lane at a time, until ask(half-faces, lanes) returns that lanes are
// done. Returns the lanes whose squares are done.
template <class Ask>
LANE_FN uint ask_faces(const PacketJob& job, Words squares, uint lanes, const Ask& ask)
{
    LaneWords square, half_face{};
    store(square, select(mask_of(lanes), squares, Words{}));
    uint unanswered = 0;
    for (uint face = 0; lanes != 0; ++face) {
        for (uint left = lanes; left != 0; left &= left - 1) {
            const uint lane = first_of(left), index = job.entry_ranges[square.of[lane]] + face;
            if (index < job.entry_ranges[square.of[lane] + 1])
                half_face.of[lane] = job.entry_half_faces[index];
            else
                unanswered |= 1u << lane;
        }
        lanes &= ~unanswered;
        lanes &= ~ask(*reinterpret_cast<const Words*>(half_face.of), lanes);
    }
    return unanswered;
}

// The lanes that enter the domain by the faces that their half-faces name.
template <int z>
LANE_FN uint lanes_entering_by(const PacketJob& job, Packet& packet, const Shear<z>& shear, uint lanes,
                               Words half_faces)
{
    Seen corners[3];
    for (uint i = 0; i < 3; ++i)
        corners[i] = seen_at(packet, shear, corners_of(job, half_faces, i).of);
    return lanes_entering(packet, lanes, corners);
}

// exit_through() of half32.h.
LANE_FN uint exit_through(const PacketJob& job, uint tet, uint face)
{
    const std::size_t record = 4 * std::size_t{tet} + (face == 0 ? 1 : 0);
    return job.records[4 * (HALF32_QUADS * record + 1) + (face <= 1 ? 0 : face - 1)];
}

// Lets lanes leave the tet that they start in by one of its faces.
template <int z>
LANE_FN void leave_first(const PacketJob& job, Packet& packet, Walk<z>& walk, uint lanes, uint face)
{
    if (lanes == 0) return;
    const uint exit = exit_through(job, job.start_tet, face);
    if ((exit & 3u) == EXIT_END)
        end_lanes(packet, lanes, all(exit), all(job.start_tet << 2), 1);
    else
        enter_record(job, packet, walk, lanes, exit >> 2);
}

// As face_left_by() of signs.h: the lanes that leave a tet by each of its faces. ties: the lanes with a tie.
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
    for (uint i = 0; i < 4; ++i)
        v[i] = apex_seen(job, packet, walk.shear, job.start_tet << 2 | i);
    const ByFace left = by_face_left(v);
    uint waiting = lanes & ~left.ties;
    for (uint face = 0; face < 4; ++face) {
        leave_first(job, packet, walk, waiting & left.of[face], face);
        waiting &= ~left.of[face];
    }
    packet.deferred |= (lanes & left.ties) | waiting;
}
