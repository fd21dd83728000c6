#pragma once

// The walk of a packet's lanes: walk_by_records.h, lane by lane. Lanes do not decide ties: a tie is rare, and the
// scalar kernel then traces that ray from its start.

constexpr uint packets_in_turns = 16; // of an image: what one of them prefetches is there when its turn comes

// Where lanes are: in front of the tet and face of their records.
struct WalkState {
    Words rotation, record;
    LaneWords offsets; // of the records, in words
    uint live;
};

// The walk of lanes that share one deepest axis.
template <int z>
struct Walk : WalkState {
    Shear<z> shear;
    Seen carried[3];
    // Of the carried vertices, and of the rays' ends. Of rays that cross tets, the vertices' coordinates (crossing.h).
    // Not used for others without an end.
    Floats depths[3], reach;
};

LANE_FN uint corner(uint face, uint index)
{
    return (0x634B39u >> (6u * face + 2u * index)) & 3u;
}
LANE_FN Words corner(Words face, uint index)
{
    return (all(0x634B39u) >> (6u * face + 2u * index)) & 3u;
}

// Record of a face's corner: the record whose apex it is.
LANE_FN uint record_of_corner(uint half_face, uint index)
{
    return (half_face & ~3u) | corner(half_face & 3u, index);
}
LANE_FN Words record_of_corner(Words half_faces, uint index)
{
    return (half_faces & all(~3u)) | corner(half_faces & 3u, index);
}

// The common place of several lanes: in front of a record, with the vertices that they carry there.
struct Front {
    uint record;
    uint carried[3]; // the records whose apexes these vertices are
    uint rotation;
};

// Lets lanes go on from there.
template <int z>
LANE_FN void go_on_from(const PacketJob& job, const Packet& packet, Walk<z>& walk, uint lanes, const Front& front)
{
    const Mask mask = mask_of(lanes);
    for (uint i = 0; i < 3; ++i)
        walk.carried[i] = select(mask, apex_seen(job, packet, walk.shear, front.carried[i]), walk.carried[i]);
    walk.rotation = select(mask, all(front.rotation), walk.rotation);
    walk.record = select(mask, all(front.record), walk.record);
    walk.live |= lanes;
}

// Lets lanes enter a tet by the face of a record.
template <int z>
LANE_FN void enter_record(const PacketJob& job, const Packet& packet, Walk<z>& walk, uint lanes, uint record)
{
    const auto corner_record = [&](uint index) { return record_of_corner(record, index); };
    go_on_from(job, packet, walk, lanes, {record, {corner_record(0), corner_record(1), corner_record(2)}, 0});
}

// Masks of the lanes that see q to the left of p, and of the lanes with a tie.
struct Sides {
    Mask left, tie;
};
LANE_FN Sides sides_of(const Seen& p, const Seen& q)
{
    const Floats plus = p.x * q.y, minus = p.y * q.x;
    return {greater(plus, minus), equal(plus, minus)};
}

// Ends lanes whose ray has met a triangle, the domain's boundary or its own end. steps: of the packet so far.
LANE_FN void end_lanes(Packet& packet, Mask lanes, Words exit, Words record, uint steps)
{
    packet.exit = select(lanes, exit, packet.exit);
    packet.record = select(lanes, record, packet.record);
    packet.steps = select(lanes, packet.steps + all(steps), packet.steps);
}

// The lanes that have ended: those of is_end, and those whose ray ends before it enters the tet across the carried
// vertices. The exit of the latter becomes NO_HALF_FACE.
template <int z>
LANE_FN Mask end_across(const Walk<z>& walk, Mask is_end, Words& exit)
{
    const Mask is_beyond =
        greater(walk.depths[0], walk.reach) & greater(walk.depths[1], walk.reach) & greater(walk.depths[2], walk.reach);
    exit = select(without(is_beyond, is_end), all(NO_HALF_FACE), exit);
    return is_end | is_beyond;
}

// The exits of lanes. replaced: masks of the lanes in which the apex replaces each carried vertex.
LANE_FN Words exits_of(WalkState& state, const Mask* replaced, const Words* exits)
{
    const Mask once = equal(state.rotation, all(1u)), twice = equal(state.rotation, all(2u));
    const auto turned_by = [&](uint i) { // what place i has: corner (i - rotation) % 3
        return select(once, exits[(i + 2) % 3], select(twice, exits[(i + 1) % 3], exits[i]));
    };
    const Words exit = select(replaced[0], turned_by(0), select(replaced[1], turned_by(1), turned_by(2)));
    const Words turned = state.rotation + (exit & all(3u));
    state.rotation = least(turned, turned - all(3u));
    return exit;
}

// Lets lanes enter the tets across their exits: only these live on, and others keep a valid record.
LANE_FN void go_on(WalkState& state, Mask lanes, Words exits)
{
    state.live = lanes_of(lanes);
    state.record = select(lanes, exits >> 2, state.record);
    store(state.offsets, state.record * (4 * HALF32_QUADS));
}

LANE_FN Mask have_left(Words tets, uint count)
{
    return equal(least(tets, all(count)), all(count));
}

// A step of all live lanes. steps: its number in the packet. GivenWalk of given.h says what the goals do.
template <Goal goal, class AnyWalk>
LANE_FN void step(const PacketJob& job, Packet& packet, AnyWalk& walk, uint steps)
{
    const Records at = load_records(job.records, walk.offsets);
    const Seen apex = seen_at(packet, walk.shear, at.apex.of);
    const Sides s0 = sides_of(walk.carried[0], apex), s1 = sides_of(walk.carried[1], apex),
                s2 = sides_of(walk.carried[2], apex);
    // As replaced_by() of kernels/walks/carried.h. Three equal sides mean that the ray misses the tet, which only wrong
    // half-faces cause; both functions then replace the third vertex.
    const Mask first = without(s2.left, s1.left), second = without(s0.left, s2.left);
    const Mask replaced[3] = {first, second, neither(first, second)};
    for (uint i = 0; i < 3; ++i) {
        replace(replaced[i], apex.x, walk.carried[i].x);
        replace(replaced[i], apex.y, walk.carried[i].y);
    }
    Words exit = exits_of(walk, replaced, at.exits.of);
    Mask undecided = s0.tie | s1.tie | s2.tie;
    if constexpr (goal == Goal::boundary)
        undecided = undecided | have_left(packet.steps + all(steps - 1u), job.max_steps);
    const Mask live = mask_of(walk.live), ties = live & undecided, decided = without(live, ties);
    Mask is_end = equal(exit & all(3u), all(EXIT_END));
    if constexpr (goal != Goal::triangle) {
        const Floats depth = depth_for(packet, walk, at.apex.of);
        for (uint i = 0; i < 3; ++i)
            walk.depths[i] = select(replaced[i], depth, walk.depths[i]);
    }
    if constexpr (goal == Goal::end) is_end = end_across(walk, is_end, exit);
    if constexpr (goal == Goal::boundary) is_end = is_end | cross(job, packet, walk, decided);
    // Without a condition: a branch would mostly be mispredicted.
    end_lanes(packet, decided & is_end, exit, walk.record, steps);
    packet.deferred |= lanes_of(ties);
    go_on(walk, without(decided, is_end), exit);
}

// Prefetches what lanes of an image load next. Neighbours often load the same record, so every other pixel will do, as
// the black fields of a chessboard.
LANE_FN void prefetch_records(const PacketJob& job, const WalkState& state)
{
    for (uint lane = 0; lane < LANES; ++lane)
        if ((lane % packet_width + lane / packet_width) % 2 == 0)
            __builtin_prefetch(job.records + state.offsets.of[lane]);
}

// Walks several packets in rotation until all lanes have ended: while one waits for its records, others compute.
// steps: the number of tets that the lanes have already left.
template <int z>
LANE_FN void walk_on(const PacketJob& job, Packet* packets, Walk<z>* walks, uint count, uint steps)
{
    for (uint i = 0; i < count; ++i) {
        store(walks[i].offsets, walks[i].record * (4 * HALF32_QUADS));
        prefetch_records(job, walks[i]);
    }
    uint live = every_lane;
    while (live != 0 && steps < job.max_steps) {
        ++steps;
        live = 0;
        for (uint i = 0; i < count; ++i) {
            if (walks[i].live == 0) continue;
            step<Goal::triangle>(job, packets[i], walks[i], steps);
            prefetch_records(job, walks[i]);
            live |= walks[i].live;
        }
    }
    for (uint i = 0; i < count; ++i)
        packets[i].deferred |= walks[i].live; // lost; the scalar kernel confirms it
}

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
LANE_FN uint test_faces(const PacketJob& job, Words squares, uint lanes, const Ask& ask)
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
        end_lanes(packet, mask_of(lanes), all(exit), all(job.start_tet << 2), 1);
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
