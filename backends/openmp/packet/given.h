// Rays that are given, which share no way: packets of rays with one deepest axis, in which lanes whose rays have ended
// take those that wait.
constexpr uint packets_in_turns = 4;
constexpr uint lanes_wanted = LANES * 3 / 4; // a packet takes rays when it walks with fewer

// Rays of one deepest axis.
struct Queue {
    const uint* next;
    const uint* end;
};

// Fetches the rays of lanes that have their numbers, and tells their links.
LANE_FN Words fetch_rays(const PacketJob& job, Packet& packet, uint lanes)
{
    const Mask mask = mask_of(lanes);
    LaneWords offsets;
    for (uint lane = 0; lane < LANES; lane++)
        offsets.of[lane] = 4 * packet.numbers.of[lane];
    const Quad direction = load_rows(job.directions, offsets), origin = load_rows(job.origins, offsets);
    for (uint axis = 0; axis < 3; axis++) {
        packet.direction[axis] = select(mask, as_floats(direction.of[axis]), packet.direction[axis]);
        packet.origin[axis] = select(mask, as_floats(origin.of[axis]), packet.origin[axis]);
    }
    const Floats end = as_floats(origin.of[3]);
    packet.end = select(mask, select(greater(all(NO_END), end), end, all(__builtin_inff())), packet.end);
    const uint outside = lanes & lanes_of(equal(direction.of[3], all(NO_LINK)));
    if (outside == 0) return direction.of[3];
    LaneWords links;
    store(links, direction.of[3]);
    for (uint left = outside; left != 0; left &= left - 1)
        links.of[first_of(left)] = job.entry_of(job.context, packet.numbers.of[first_of(left)]);
    return *reinterpret_cast<const Words*>(links.of);
}

// Lets lanes leave the tets that their rays start in: exit_from_face() of path.h, and as a step what it finds. Where
// the rays leave by face 0 that step is from the record of face 1, else from that of face 0. steps: of the packet.
template <int z, bool has_ends>
LANE_FN void leave_tets(const PacketJob& job, Packet& packet, Walk<z>& walk, uint lanes, Words links, uint steps)
{
    const Mask mask = mask_of(lanes);
    constexpr uint record_words = 4 * HALF32_ROWS;
    LaneWords offsets;
    store(offsets, select(mask, (links >> 2) * (4 * record_words), Words{}));
    const Records first = load_records(job.records, offsets),
                  second = load_records(job.records + record_words, offsets);
    const Quad apexes[4] = {first.apex, second.apex, load_rows(job.records + 2 * record_words, offsets),
                            load_rows(job.records + 3 * record_words, offsets)};
    Seen v[4];
    for (uint i = 0; i < 4; i++)
        v[i] = seen_at(packet, walk.shear, apexes[i].of);
    const ByFace left = by_face_left(v);
    const Mask by[4] = {mask_of(left.of[0]), mask_of(left.of[1]), mask_of(left.of[2]), mask_of(left.of[3])};
    const auto carry = [&](uint i, const auto& p0, const auto& p1, const auto& p2,
                           auto& to) { // face 0, face i + 1, others
        to = select(mask, select(by[0], p0, select(by[i + 1], p1, p2)), to);
    };
    const uint behind_first[3] = {1, 3, 2};
    for (uint i = 0; i < 3; i++) {
        carry(i, v[behind_first[i]].x, v[0].x, v[i + 1].x, walk.carried[i].x);
        carry(i, v[behind_first[i]].y, v[0].y, v[i + 1].y, walk.carried[i].y);
    }
    const Words record = (links & all(~3u)) + select(by[0], all(1u), Words{});
    Words exit = select(by[0], second.exits.of[0],
                        select(by[1], first.exits.of[0], select(by[2], first.exits.of[1], first.exits.of[2])));
    Mask is_end = equal(exit & all(3u), all(HALF32_END));
    if constexpr (has_ends) {
        Floats depths[4];
        for (uint i = 0; i < 4; i++)
            depths[i] = depth_at(packet, apexes[i].of);
        for (uint i = 0; i < 3; i++)
            carry(i, depths[behind_first[i]], depths[0], depths[i + 1], walk.depths[i]);
        walk.reach = depth_of_end(packet);
        const Mask is_beyond = without(lies_beyond(walk), is_end);
        exit = select(is_beyond, all(NO_LINK), exit);
        is_end = is_end | is_beyond;
    }
    const Words entry = links & all(3u);
    const uint back = (left.of[0] & lanes_of(equal(entry, Words{}))) | (left.of[1] & lanes_of(equal(entry, all(1u)))) |
                      (left.of[2] & lanes_of(equal(entry, all(2u)))) | (left.of[3] & lanes_of(equal(entry, all(3u))));
    const uint forth = lanes & (left.of[0] | left.of[1] | left.of[2] | left.of[3]) & ~(back | left.ties);
    packet.left_to_scalar |= lanes & ~forth;
    packet.steps = select(mask, all(1u - steps), packet.steps);
    end_lanes(packet, forth & lanes_of(is_end), exit, record, steps);
    walk.live |= forth & ~lanes_of(is_end);
    walk.turn = select(mask, exit & all(3u), walk.turn);
    walk.record = select(mask_of(walk.live) & mask, exit >> 2, walk.record);
    store(walk.offsets, walk.record * record_words);
}

// Writes what has ended in a packet, and lets its free lanes take rays. steps: that the packet has done.
template <int z, bool has_ends>
[[gnu::noinline]] void take_rays(const PacketJob& job, Queue& queue, Packet& packet, Walk<z>& walk, uint steps)
{
    const Words most = all(job.max_steps);
    const auto are_too_many = [&](Words a) { return lanes_of(equal(least(a, most), most)); };
    const uint lost = walk.live & are_too_many(packet.steps + all(steps));
    walk.live &= ~lost;
    const uint ended = packet.lanes & ~walk.live;
    packet.left_to_scalar |= lost | (ended & are_too_many(packet.steps));
    if (ended != 0) write_hits(job, packet, ended);
    packet.lanes = walk.live;
    packet.left_to_scalar = 0;
    uint taken = 0;
    for (uint free = every_lane & ~walk.live; free != 0 && queue.next != queue.end; free &= free - 1) {
        packet.numbers.of[first_of(free)] = *queue.next++;
        taken |= free & -free;
    }
    if (taken == 0) return;
    const Words links = fetch_rays(job, packet, taken);
    const Mask mask = mask_of(taken);
    const Shear<z> shear = shear_of<z>(packet.direction);
    walk.shear = shear;
    packet.lanes |= taken;
    packet.exit = select(mask, all(NO_LINK), packet.exit);
    packet.record = select(mask, all(NO_LINK), packet.record);
    packet.steps = select(mask, Words{}, packet.steps);
    leave_tets<z, has_ends>(job, packet, walk, taken & ~lanes_of(equal(links, all(NO_LINK))), links, steps);
}

template <int z, bool has_ends>
[[gnu::noinline]] void trace_queue(const PacketJob& job, Queue queue)
{
    Packet packets[packets_in_turns];
    Walk<z> walks[packets_in_turns];
    uint checked[packets_in_turns] = {};
    for (uint i = 0; i < packets_in_turns; i++) {
        __builtin_memset(&packets[i], 0, sizeof(Packet));
        __builtin_memset(&walks[i], 0, sizeof(Walk<z>));
    }
    uint steps = 0;
    bool goes_on = true;
    while (goes_on) {
        goes_on = false;
        for (uint i = 0; i < packets_in_turns; i++) {
            if (walks[i].live != 0) step<z, has_ends>(job, packets[i], walks[i], steps);
            const auto live = static_cast<uint>(__builtin_popcount(walks[i].live));
            const bool takes = live < lanes_wanted && queue.next != queue.end;
            const bool has_ended = live == 0 && packets[i].lanes != 0;
            if (takes || has_ended || steps - checked[i] >= job.max_steps) {
                take_rays<z, has_ends>(job, queue, packets[i], walks[i], steps);
                checked[i] = steps;
            }
            goes_on = goes_on || packets[i].lanes != 0;
        }
        steps++;
    }
}

LANE_FN uint deepest_axis(const uint* direction)
{
    const uint x = direction[0] & 0x7FFFFFFFu, y = direction[1] & 0x7FFFFFFFu, z = direction[2] & 0x7FFFFFFFu;
    const uint of_xy = y > x ? 1 : 0; // bits of magnitudes have their order
    return z > (x < y ? y : x) ? 2 : of_xy;
}

template <bool has_ends>
LANE_FN void trace_queues(const PacketJob& job, const Queue* queues)
{
    trace_queue<0, has_ends>(job, queues[0]);
    trace_queue<1, has_ends>(job, queues[1]);
    trace_queue<2, has_ends>(job, queues[2]);
}

// Given rays [first, end), those of each deepest axis by themselves.
LANE_FN void trace_range(const PacketJob& job, uint first, uint end)
{
    uint numbers[3][tetrace::openmp::packet_range_size];
    uint counts[3] = {};
    for (uint number = first; number < end; number++) {
        const uint axis = deepest_axis(job.directions + 4 * std::size_t{number});
        numbers[axis][counts[axis]++] = number;
    }
    Queue queues[3];
    for (uint axis = 0; axis < 3; axis++)
        queues[axis] = {numbers[axis], numbers[axis] + counts[axis]};
    if (job.has_ends)
        trace_queues<true>(job, queues);
    else
        trace_queues<false>(job, queues);
}
