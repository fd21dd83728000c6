// The walk of a packet's lanes: walk_by_records.h, lane by lane. Lanes do not decide ties: a tie is rare, and the
// scalar kernel then traces that ray from its start.

constexpr uint packets_in_turns = 8; // enough that what one of them prefetches is there when its turn comes

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
    Floats depths[3], reach; // of the carried vertices, and of the rays' ends; used only if rays have ends
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
LANE_FN void end_lanes(Packet& packet, uint lanes, Words exit, Words record, uint steps)
{
    const Mask mask = mask_of(lanes);
    packet.exit = select(mask, exit, packet.exit);
    packet.record = select(mask, record, packet.record);
    packet.steps = select(mask, packet.steps + all(steps), packet.steps);
}

// The lanes that have ended: those of is_end, and those whose ray ends before it enters the tet across the carried
// vertices. The exit of the latter becomes NO_HALF_FACE.
template <int z>
LANE_FN Mask end_behind(const Walk<z>& walk, Mask is_end, Words& exit)
{
    const Mask is_beyond =
        greater(walk.depths[0], walk.reach) & greater(walk.depths[1], walk.reach) & greater(walk.depths[2], walk.reach);
    exit = select(without(is_beyond, is_end), all(NO_HALF_FACE), exit);
    return is_end | is_beyond;
}

// The exits of lanes. replaced: masks of the lanes in which the apex replaces each carried vertex.
LANE_FN Words exits_of(WalkState& state, const Mask* replaced, const Words* exits)
{
    const Words place = select(replaced[1], all(1u), select(replaced[2], all(2u), Words{})) - state.rotation;
    const Words index = least(place, place + all(3u)); // of the corner; a value below 0 wraps to a large number
    const Words exit = select(equal(index, all(1u)), exits[1], select(equal(index, all(2u)), exits[2], exits[0]));
    const Words turned = state.rotation + (exit & all(3u));
    state.rotation = least(turned, turned - all(3u));
    return exit;
}

// Lets live lanes enter the tets across their exits; others keep a valid record.
LANE_FN void enter_tets(WalkState& state, Words exits)
{
    state.record = select(mask_of(state.live), exits >> 2, state.record);
    store(state.offsets, state.record * (4 * HALF32_QUADS));
}

// A step of all live lanes. steps: its number in the packet.
template <int z, bool has_ends>
LANE_FN void step(const PacketJob& job, Packet& packet, Walk<z>& walk, uint steps)
{
    const Records at = load_records(job.records, walk.offsets);
    const Seen apex = seen_at(packet, walk.shear, at.apex.of);
    const Sides s0 = sides_of(walk.carried[0], apex), s1 = sides_of(walk.carried[1], apex),
                s2 = sides_of(walk.carried[2], apex);
    // As replaced_by() of kernels/walks/carried.h. Three equal sides mean that the ray misses the tet, which only wrong
    // half-faces cause; both functions then replace the third vertex.
    const Mask first = without(s2.left, s1.left), second = without(s0.left, s2.left);
    const Mask replaced[3] = {first, second, neither(first, second)};
    for (uint i = 0; i < 3; ++i)
        walk.carried[i] = select(replaced[i], apex, walk.carried[i]);
    Words exit = exits_of(walk, replaced, at.exits.of);
    const uint ties = walk.live & lanes_of(s0.tie | s1.tie | s2.tie);
    Mask is_end = equal(exit & all(3u), all(EXIT_END));
    if constexpr (has_ends) {
        const Floats depth = depth_at(packet, at.apex.of);
        for (uint i = 0; i < 3; ++i)
            walk.depths[i] = select(replaced[i], depth, walk.depths[i]);
        is_end = end_behind(walk, is_end, exit);
    }
    const uint ended = walk.live & ~ties & lanes_of(is_end);
    end_lanes(packet, ended, exit, walk.record, steps); // without a condition: a branch would mostly be mispredicted
    packet.deferred |= ties;
    walk.live &= ~(ties | ended);
    enter_tets(walk, exit);
}

// Walks several packets in rotation until all lanes have ended: while one waits for its records, others compute.
// steps: the number of tets that the lanes have already left.
template <int z>
LANE_FN void walk_on(const PacketJob& job, Packet* packets, Walk<z>* walks, uint count, uint steps)
{
    for (uint i = 0; i < count; ++i) {
        store(walks[i].offsets, walks[i].record * (4 * HALF32_QUADS));
        prefetch_quads(job.records, walks[i].offsets);
    }
    uint live = every_lane;
    while (live != 0 && steps < job.max_steps) {
        ++steps;
        live = 0;
        for (uint i = 0; i < count; ++i) {
            if (walks[i].live == 0) continue;
            step<z, false>(job, packets[i], walks[i], steps);
            prefetch_quads(job.records, walks[i].offsets);
            live |= walks[i].live;
        }
    }
    for (uint i = 0; i < count; ++i)
        packets[i].deferred |= walks[i].live; // lost; the scalar kernel confirms it
}
