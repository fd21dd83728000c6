// The hits of a packet's lanes: make_hit() of hit.h, lane by lane, and hits in memory.

// The six words of a hit.
struct Hits {
    Words of[HIT_WORDS];
};

// The lanes that have met a triangle.
LANE_FN uint lanes_hitting(const Packet& packet, uint lanes)
{
    return lanes & ~packet.deferred & ~lanes_of(equal(packet.exit, all(NO_HALF_FACE)));
}

LANE_FN void prefetch_triangle(const PacketJob& job, uint exit)
{
    const uint* const triangle = job.triangles + 4 * TRIANGLE_QUADS * std::size_t{exit >> 2};
    __builtin_prefetch(triangle);
    __builtin_prefetch(triangle + 4 * TRIANGLE_QUADS - 1);
}

// Prefetches the triangles that a packet has met, while those of other packets are tested.
LANE_FN void prefetch_triangles(const PacketJob& job, const Packet& packet)
{
    LaneWords exit;
    store(exit, packet.exit);
    for (uint left = lanes_hitting(packet, packet.lanes); left != 0; left &= left - 1)
        prefetch_triangle(job, exit.of[first_of(left)]);
}

// The triangle, t, u and v of lanes that hit one, for rays that do not end before it. A ray that sees
// its triangle edge-on is left to the scalar kernel.
LANE_FN void meet_triangles(const PacketJob& job, Packet& packet, uint lanes, Hits& hits)
{
    LaneWords offsets;
    store(offsets, select(mask_of(lanes), (packet.exit >> 2) * (4 * TRIANGLE_QUADS), Words{}));
    const Quad quads[3] = {load_quads(job.triangles, offsets), load_quads(job.triangles + 4, offsets),
                           load_quads(job.triangles + 8, offsets)};
    const auto vectors = [](const Quad& quad) {
        return Vectors{as_floats(quad.of[0]), as_floats(quad.of[1]), as_floats(quad.of[2])};
    };
    const Vectors v0 = vectors(quads[0]), edge_1 = vectors(quads[1]), edge_2 = vectors(quads[2]);
    const Vectors direction = {packet.direction[0], packet.direction[1], packet.direction[2]};
    const Vectors offset = sub3({packet.origin[0], packet.origin[1], packet.origin[2]}, v0);
    const Vectors p = cross3(direction, edge_2), q = cross3(offset, edge_1);
    const Floats determinant = dot3(edge_1, p), along = dot3(edge_2, q), limit = packet.end * determinant;
    const Mask is_beyond = (greater(determinant, Floats{}) & greater(along, limit)) |
                           (greater(Floats{}, determinant) & greater(limit, along));
    const Mask mask = without(mask_of(lanes), is_beyond);
    hits.of[0] = select(mask, packet.exit >> 2, hits.of[0]);
    hits.of[2] = select(mask, as_words(along / determinant), Words{});
    hits.of[3] = select(mask, as_words(dot3(offset, p) / determinant), Words{});
    hits.of[4] = select(mask, as_words(dot3(direction, q) / determinant), Words{});
    const Floats size = dot3(magnitudes(edge_1), cross3_size(magnitudes(direction), magnitudes(edge_2)));
    packet.deferred |= lanes & ~lanes_of(greater(magnitude(determinant), size * 0x1p-20f));
}

// Hits of LANES lanes, each as its first four words and its last two.
LANE_FN void write_words(const PacketJob& job, const Packet& packet, uint lanes, const Hits& hits)
{
    const Quad first = transposed(hits.of[0], hits.of[1], hits.of[2], hits.of[3]);
    LaneWords firsts[4], lasts[2];
    for (uint i = 0; i < 4; ++i)
        store(firsts[i], first.of[i]);
    store(lasts[0], __builtin_shufflevector(hits.of[4], hits.of[5], LOW_WORDS));
    store(lasts[1], __builtin_shufflevector(hits.of[4], hits.of[5], HIGH_WORDS));
    for (; lanes != 0; lanes &= lanes - 1) {
        const uint lane = first_of(lanes), quarter = lane & ~3u;
        uint* const to = job.hits + HIT_WORDS * std::size_t{packet.numbers.of[lane]};
        __builtin_memcpy(to, &firsts[lane & 3u].of[quarter], 16);
        __builtin_memcpy(to + 4, &lasts[(lane >> 1) & 1u].of[quarter + 2 * (lane & 1u)], 8);
    }
}

// The hits of lanes whose rays have ended, or are left to the scalar kernel.
[[gnu::noinline]] void write_hits(const PacketJob& job, Packet& packet, uint lanes)
{
    Hits hits{};
    hits.of[0] = all(NO_HIT);
    hits.of[1] = packet.record >> 2; // NO_TET for a ray that entered none
    hits.of[5] = packet.steps;
    const uint hitting = lanes_hitting(packet, lanes);
    if (hitting != 0) meet_triangles(job, packet, hitting, hits);
    write_words(job, packet, lanes & ~packet.deferred, hits);
    for (uint left = lanes & packet.deferred; left != 0; left &= left - 1)
        job.trace_one(job, packet.numbers.of[first_of(left)]);
}

// The words of one miss over and over: a row of misses is these vectors in turn.
struct Misses {
    Words of[3];
};
LANE_FN Misses misses_of(uint tet, uint steps)
{
    Misses misses;
    for (uint i = 0; i < 3; ++i)
        for (uint lane = 0; lane < LANES; ++lane) {
            const uint word = (i * LANES + lane) % HIT_WORDS;
            misses.of[i][lane] = word == 0 ? NO_HIT : word == 1 ? tet : word == 5 ? steps : 0;
        }
    return misses;
}

// The hits of a packet, from pixel (x, y) on, whose rays all leave the domain from the same tet after as many steps.
LANE_FN void write_misses(const PacketJob& job, uint x, uint y, uint tet, uint steps)
{
    constexpr uint vectors = HIT_WORDS * packet_width / LANES, rest = HIT_WORDS * packet_width % LANES; // of a row
    const Misses misses = misses_of(tet, steps);
    uint* row = job.hits + HIT_WORDS * number_in_block(job, x, y);
    for (uint i = 0; i < packet_height; ++i, row += HIT_WORDS * tetrace::openmp::packet_block_size) {
        for (uint j = 0; j < vectors; ++j)
            __builtin_memcpy(row + j * LANES, &misses.of[j % 3], sizeof(Words));
        if (rest != 0) __builtin_memcpy(row + vectors * LANES, &misses.of[vectors % 3], rest * sizeof(uint));
    }
}
