// Given rays, which do not stay together: a lane whose ray has ended takes a waiting ray. The entry into the domain is
// found before, and the hit on the triangle after, in packets all of whose lanes have such a ray.
constexpr uint given_in_turns = 8; // with more, what they prefetch exceeds what a processor can wait for
// A packet takes new rays when it has fewer live lanes. A step that crosses tets costs several times as much.
template <Goal goal>
constexpr uint lanes_wanted = goal == Goal::boundary ? 3 * LANES / 4 : LANES / 4;
constexpr uint rays_at_once = 512; // that a thread takes at a time
constexpr uint rays_ahead = 32;    // whose tets are prefetched before the rays are taken

constexpr uint record_words = 4 * HALF32_QUADS, tet_words = 4 * record_words;

constexpr uint deferred_half_face = NO_HALF_FACE - 1; // of no face

template <Goal goal>
struct GivenWalk : Walk<any_axis> {
};
template <>
struct GivenWalk<Goal::boundary> : CrossingWalk {
};

// What rays with an end carry of a vertex besides where they see it; crossing.h has that of rays that cross tets.
LANE_FN Floats depth_for(const Packet& packet, const GivenWalk<Goal::end>&, const Words* place)
{
    return depth_at(packet, place);
}

// Numbers of the rays that this thread has taken, of which those from `next` on wait. entered: by ray from `first` on,
// the half-faces by which those from outside enter the domain, NO_HALF_FACE if they miss it, deferred_half_face for the
// scalar kernel.
struct Queue {
    uint first, next, end;
    alignas(4 * LANES) uint entered[rays_at_once];
};

// Prefetches the two cache lines of the tet that a given ray's half-face names.
LANE_FN void prefetch_tet(const PacketJob& job, uint number)
{
    const uint half_face = job.directions[4 * std::size_t{number} + 3];
    if (half_face == NO_HALF_FACE) return;
    const uint* const records = job.records + std::size_t{tet_words} * (half_face >> 2);
    __builtin_prefetch(records);
    __builtin_prefetch(records + tet_words / 2);
}

// Fetches the rays of lanes by their numbers, and returns their half-faces.
LANE_FN Words fetch_rays(const PacketJob& job, Packet& packet, uint lanes)
{
    const Mask mask = mask_of(lanes);
    LaneWords offsets;
    store(offsets, *reinterpret_cast<const Words*>(packet.numbers.of) * 4);
    const Quad direction = load_quads(job.directions, offsets), origin = load_quads(job.origins, offsets);
    for (uint axis = 0; axis < 3; ++axis) {
        packet.direction[axis] = select(mask, as_floats(direction.of[axis]), packet.direction[axis]);
        packet.origin[axis] = select(mask, as_floats(origin.of[axis]), packet.origin[axis]);
    }
    const Floats end = as_floats(origin.of[3]);
    packet.end = select(mask, select(greater(all(NO_END), end), end, all(__builtin_inff())), packet.end);
    return direction.of[3];
}

// Rays of a queue that have a face to ask: the first and the end of those of their squares that are left.
struct Asking {
    uint count, numbers[rays_at_once], faces[rays_at_once], ends[rays_at_once];
};

LANE_FN void push(Asking& asking, uint number, uint face, uint end)
{
    if (face == end) return;
    asking.numbers[asking.count] = number;
    asking.faces[asking.count] = face;
    asking.ends[asking.count++] = end;
}

// Finds the squares in which the queue's rays from outside meet the domain.
LANE_FN void find_squares(const PacketJob& job, Queue& queue, Asking& asking)
{
    Packet packet{};
    for (uint first = queue.first; first < queue.end; first += LANES) {
        const uint lanes = first_lanes(queue.end - first);
        for (uint lane = 0; lane < LANES; ++lane)
            packet.numbers.of[lane] = lanes >> lane & 1u ? first + lane : first;
        const Mask outside = equal(fetch_rays(job, packet, every_lane), all(NO_HALF_FACE));
        const Words squares = entry_squares(job, packet);
        const Mask meeting = without(outside, equal(squares, all(6 * job.divisions * job.divisions)));
        *reinterpret_cast<Words*>(queue.entered + (first - queue.first)) =
            select(meeting, all(deferred_half_face), all(NO_HALF_FACE)); // left unless a face is found
        LaneWords square;
        store(square, squares);
        for (uint left = lanes & lanes_of(meeting); left != 0; left &= left - 1) {
            const uint* const range = job.entry_ranges + square.of[first_of(left)];
            push(asking, first + first_of(left), range[0], range[1]);
        }
    }
}

// Finds where the queue's rays enter the domain: each asks a face at a time of its square.
[[gnu::noinline]] void enter_domain(const PacketJob& job, Queue& queue)
{
    Asking asking;
    asking.count = 0;
    find_squares(job, queue, asking);
    Packet packet{};
    LaneWords half_face{};
    for (uint& number : packet.numbers.of)
        number = queue.first;
    while (asking.count != 0) {
        const uint count = asking.count;
        asking.count = 0; // rays that ask once more take the places of rays that have asked
        for (uint first = 0; first < count; first += LANES) {
            const uint lanes = first_lanes(count - first);
            for (uint left = lanes; left != 0; left &= left - 1) {
                const uint lane = first_of(left);
                packet.numbers.of[lane] = asking.numbers[first + lane];
                half_face.of[lane] = job.entry_half_faces[asking.faces[first + lane]];
            }
            fetch_rays(job, packet, every_lane);
            packet.deferred = 0;
            const uint entering = lanes_entering_by(job, packet, shear_of<any_axis>(packet.direction), lanes,
                                                    *reinterpret_cast<const Words*>(half_face.of));
            for (uint left = entering; left != 0; left &= left - 1)
                queue.entered[packet.numbers.of[first_of(left)] - queue.first] = half_face.of[first_of(left)];
            for (uint left = lanes & ~(entering | packet.deferred); left != 0; left &= left - 1) {
                const uint i = first + first_of(left);
                push(asking, asking.numbers[i], asking.faces[i] + 1, asking.ends[i]);
            }
        }
    }
}

// Whether a ray waits, or may be taken.
LANE_FN bool may_have_rays(const PacketJob& job, const Queue& queue)
{
    return queue.next != queue.end || queue.end < job.ray_count;
}

// Whether a ray waits; takes more rays first if none does.
LANE_FN bool has_rays(const PacketJob& job, Queue& queue)
{
    if (queue.next == queue.end && may_have_rays(job, queue)) {
        const auto at_most = [&](uint number) { return number < job.ray_count ? number : job.ray_count; };
        queue.first = queue.next = at_most(__atomic_fetch_add(job.next_ray, rays_at_once, __ATOMIC_RELAXED));
        queue.end = at_most(queue.first + rays_at_once);
        if (job.starts_outside) enter_domain(job, queue);
    }
    return queue.next != queue.end;
}

// Selects carried vertex i, or a property of it, from those of the four vertices of lanes' tets. A ray that leaves by
// face 0 is treated as if it had entered by face 1 (corners 0 3 2), any other as if it had entered by face 0 (corners 1
// 2 3).
template <class T>
LANE_FN T carried_across(const Mask* by_face, const T* of, uint i)
{
    constexpr uint behind_first[3] = {1, 3, 2};
    return select(by_face[0], of[behind_first[i]], select(by_face[i + 1], of[0], of[i + 1]));
}

// Lets lanes leave the tets in which their rays start, as exit_from_face() of path.h. steps: of the packet.
template <Goal goal>
LANE_FN void leave_tets(const PacketJob& job, Packet& packet, GivenWalk<goal>& walk, uint lanes, Words half_faces,
                        uint steps)
{
    const Mask mask = mask_of(lanes);
    LaneWords offsets;
    store(offsets, select(mask, (half_faces >> 2) * tet_words, Words{}));
    const Records first = load_records(job.records, offsets),
                  second = load_records(job.records + record_words, offsets);
    const Quad apexes[4] = {first.apex, second.apex, load_quads(job.records + 2 * record_words, offsets),
                            load_quads(job.records + 3 * record_words, offsets)};
    Seen v[4];
    for (uint i = 0; i < 4; ++i)
        v[i] = seen_at(packet, walk.shear, apexes[i].of);
    const ByFace left = by_face_left(v);
    const Mask by_face[4] = {mask_of(left.of[0]), mask_of(left.of[1]), mask_of(left.of[2]), mask_of(left.of[3])};
    const auto by = [&](Words a, Words b, Words c, Words d) {
        return select(by_face[0], a, select(by_face[1], b, select(by_face[2], c, d)));
    };
    const uint back = lanes_of(equal(by(all(0u), all(1u), all(2u), all(3u)), half_faces & 3u));
    const uint leaving = lanes & (left.of[0] | left.of[1] | left.of[2] | left.of[3]) & ~(back | left.ties);
    packet.deferred |= lanes & ~leaving;

    Words exit = by(second.exits.of[0], first.exits.of[0], first.exits.of[1], first.exits.of[2]);
    Mask is_end = equal(exit & 3u, all(EXIT_END));
    for (uint i = 0; i < 3; ++i)
        walk.carried[i] = select(mask, carried_across(by_face, v, i), walk.carried[i]);
    if constexpr (goal != Goal::triangle) {
        Floats depths[4];
        for (uint i = 0; i < 4; ++i)
            depths[i] = depth_for(packet, walk, apexes[i].of);
        for (uint i = 0; i < 3; ++i)
            walk.depths[i] = select(mask, carried_across(by_face, depths, i), walk.depths[i]);
    }
    if constexpr (goal == Goal::end) {
        walk.reach = depth_of_end(packet);
        is_end = end_across(walk, is_end, exit);
    }
    if constexpr (goal == Goal::boundary) {
        begin_crossing(walk, mask_of(leaving), half_faces, place_of_origin(packet, walk));
        walk.record = select(mask_of(leaving), half_faces, walk.record);
        is_end = is_end | cross(job, packet, walk, mask_of(leaving));
    }
    const uint ended = leaving & lanes_of(is_end);
    packet.steps = select(mask, all(1u - steps), packet.steps);
    end_lanes(packet, mask_of(ended), exit, half_faces, steps);
    walk.live |= leaving & ~ended;
    walk.rotation = select(mask, exit & 3u, walk.rotation);
    walk.record = select(mask_of(leaving & ~ended), exit >> 2, walk.record);
    store(walk.offsets, walk.record * record_words);
}

// Lets lanes enter the domain where enter_domain() has found that they do.
template <Goal goal>
LANE_FN void enter_records(const PacketJob& job, const Queue& queue, Packet& packet, GivenWalk<goal>& walk, uint lanes,
                           uint steps)
{
    LaneWords half_face_of{};
    uint entering = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
        const uint lane = first_of(lanes), half_face = queue.entered[packet.numbers.of[lane] - queue.first];
        if (half_face == deferred_half_face) packet.deferred |= 1u << lane;
        if (half_face == deferred_half_face || half_face == NO_HALF_FACE) continue;
        half_face_of.of[lane] = half_face;
        entering |= 1u << lane;
    }
    const Words half_faces = *reinterpret_cast<const Words*>(half_face_of.of);
    const Mask mask = mask_of(entering);
    for (uint i = 0; i < 3; ++i) {
        const Quad corner = corners_of(job, half_faces, i);
        walk.carried[i] = select(mask, seen_at(packet, walk.shear, corner.of), walk.carried[i]);
        if constexpr (goal != Goal::triangle)
            walk.depths[i] = select(mask, depth_for(packet, walk, corner.of), walk.depths[i]);
    }
    if constexpr (goal == Goal::end) walk.reach = depth_of_end(packet);
    if constexpr (goal == Goal::boundary) begin_crossing(walk, mask, half_faces, places_of(packet, walk, mask));
    packet.steps = select(mask, all(0u - steps), packet.steps);
    walk.live |= entering;
    walk.rotation = select(mask, Words{}, walk.rotation);
    walk.record = select(mask, half_faces, walk.record);
    store(walk.offsets, walk.record * record_words);
}

// Rays that have met triangles, in a ring, until these are loaded and there are enough of them for a packet. first,
// end: numbers of places, not reduced.
struct Met {
    static constexpr uint room = 4 * LANES;
    uint first, end;
    alignas(4 * LANES) uint numbers[room], exits[room], records[room], steps[room];
};

// Adds lanes that have met triangles. They fit as long as fewer than 2 * LANES rays wait.
LANE_FN void push(const PacketJob& job, Met& met, const Packet& packet, uint lanes)
{
    LaneWords exit, record, steps;
    store(exit, packet.exit);
    store(record, packet.record);
    store(steps, packet.steps);
    for (; lanes != 0; lanes &= lanes - 1) {
        const uint lane = first_of(lanes), place = met.end++ % Met::room;
        met.numbers[place] = packet.numbers.of[lane];
        met.exits[place] = exit.of[lane];
        met.records[place] = record.of[lane];
        met.steps[place] = steps.of[lane];
        prefetch_triangle(job, exit.of[lane]);
    }
}

// Writes the hits of the first rays, at most LANES, that have met triangles.
[[gnu::noinline]] void write_first(const PacketJob& job, Met& met)
{
    const uint lanes = first_lanes(met.end - met.first), place = met.first % Met::room;
    const auto words = [&](const uint* of) { return *reinterpret_cast<const Words*>(of + place); };
    Packet packet{};
    store(packet.numbers, words(met.numbers));
    fetch_rays(job, packet, every_lane);
    packet.exit = words(met.exits);
    packet.record = words(met.records);
    packet.steps = words(met.steps);
    write_hits(job, packet, lanes);
    met.first += static_cast<uint>(__builtin_popcount(lanes));
}

// Writes the hits of lanes that have met no triangle; the others wait.
LANE_FN void write_ended(const PacketJob& job, Met& met, Packet& packet, uint ended)
{
    const uint hitting = lanes_hitting(packet, ended);
    if (ended != hitting) write_hits(job, packet, ended & ~hitting);
    push(job, met, packet, hitting);
    while (met.end - met.first >= 2 * LANES)
        write_first(job, met);
}

// Ends a packet's lanes whose rays have ended, and lets its free lanes take new rays. steps: of the packet so far.
template <Goal goal>
[[gnu::noinline]] void take_rays(const PacketJob& job, Queue& queue, Met& met, Packet& packet, GivenWalk<goal>& walk,
                                 uint steps)
{
    const uint lost = walk.live & lanes_of(have_left(packet.steps + all(steps), job.max_steps));
    walk.live &= ~lost;
    const uint ended = packet.lanes & ~walk.live;
    packet.deferred |= lost | (ended & lanes_of(have_left(packet.steps, job.max_steps)));
    if constexpr (goal == Goal::boundary)
        write_answers(job, packet, walk, ended);
    else
        write_ended(job, met, packet, ended);
    packet.lanes = walk.live;
    packet.deferred = 0;
    uint taken = 0;
    for (uint free = every_lane & ~walk.live; free != 0 && queue.next != queue.end; free &= free - 1) {
        packet.numbers.of[first_of(free)] = queue.next++;
        taken |= free & -free;
        if (queue.next + rays_ahead < job.ray_count) prefetch_tet(job, queue.next + rays_ahead);
    }
    if (taken == 0) return;
    const Words half_faces = fetch_rays(job, packet, taken);
    const Mask mask = mask_of(taken);
    walk.shear = shear_of<any_axis>(packet.direction);
    packet.lanes |= taken;
    packet.exit = select(mask, all(NO_HALF_FACE), packet.exit);
    packet.record = select(mask, all(NO_HALF_FACE), packet.record);
    packet.steps = select(mask, Words{}, packet.steps);
    if constexpr (goal == Goal::boundary) clear_crossing(packet, walk, mask);
    const uint outside = taken & lanes_of(equal(half_faces, all(NO_HALF_FACE))), inside = taken & ~outside;
    if (outside != 0) enter_records(job, queue, packet, walk, outside, steps);
    if (inside != 0) leave_tets(job, packet, walk, inside, half_faces, steps);
}

template <Goal goal>
[[gnu::noinline]] void trace_rays(const PacketJob& job)
{
    Queue queue;
    queue.first = queue.next = queue.end = 0;
    Met met;
    __builtin_memset(&met, 0, sizeof met);
    Packet packets[given_in_turns];
    GivenWalk<goal> walks[given_in_turns];
    uint checked[given_in_turns] = {};
    for (uint i = 0; i < given_in_turns; ++i) {
        __builtin_memset(&packets[i], 0, sizeof(Packet));
        __builtin_memset(&walks[i], 0, sizeof(GivenWalk<goal>));
    }
    bool goes_on = true;
    for (uint steps = 0; goes_on; ++steps) {
        goes_on = may_have_rays(job, queue); // even if all lanes have just run out of steps
        for (uint i = 0; i < given_in_turns; ++i) {
            const auto live = static_cast<uint>(__builtin_popcount(walks[i].live));
            const bool takes = live < lanes_wanted<goal> && has_rays(job, queue);
            const bool has_ended = live == 0 && packets[i].lanes != 0;
            if (takes || has_ended || steps - checked[i] >= job.max_steps) {
                take_rays(job, queue, met, packets[i], walks[i], steps);
                checked[i] = steps;
            }
            if (walks[i].live != 0) {
                step<goal>(job, packets[i], walks[i], steps + 1);
                prefetch_quads(job.records, walks[i].offsets);
                if constexpr (goal == Goal::boundary) prefetch_sums(job, walks[i]);
            }
            goes_on = goes_on || packets[i].lanes != 0;
        }
    }
    while (met.first != met.end)
        write_first(job, met);
}
