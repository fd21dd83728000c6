#pragma once

// The rays of a packet, one per lane; in an image, LANES neighbouring pixels, 4 x 4, 4 x 2 or 2 x 2. The operations are
// exactly those of ray.h and shear.h. Include after lanes.h.
constexpr uint packet_width = LANES == 4 ? 2 : 4;
constexpr uint packet_height = LANES / packet_width;

struct Vectors {
    Floats x, y, z;
};
LANE_FN Vectors sub3(const Vectors& a, const Vectors& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LANE_FN Vectors magnitudes(const Vectors& a)
{
    return {magnitude(a.x), magnitude(a.y), magnitude(a.z)};
}
LANE_FN Vectors cross3_size(const Vectors& a, const Vectors& b)
{
    return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}
LANE_FN Floats dot3(const Vectors& a, const Vectors& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LANE_FN Vectors cross3(const Vectors& a, const Vectors& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Packet {
    LaneWords numbers; // of the rays: by pixel of the block, row after row, or in the order in which they are given
    Floats origin[3], direction[3];
    Floats end;    // the largest ray parameter of a hit; of rays that cross tets, the bits of their stretch
    uint lanes;    // that have a ray
    uint deferred; // lanes with a tie or another rare case
    // How a ray has ended: the exit's word, the record of the last tet that it left, the number of tets left. For a ray
    // that has not ended, `steps` is that number minus the packet's steps.
    Words exit, record, steps;
};

// Rays through these places of the image, in pixels. The caller sets which lanes have a ray.
LANE_FN void make_rays_through(const PacketJob& job, Floats column, Floats row, Packet& packet)
{
    for (uint axis = 0; axis < 3; ++axis) {
        const Floats d = all(job.corner[axis]) + all(job.step_x[axis]) * column + all(job.step_y[axis]) * row;
        packet.direction[axis] = select(greater(all(0x1p-20f), magnitude(d)), Floats{}, d);
        packet.origin[axis] = all(job.origin[axis]);
    }
    packet.end = all(__builtin_inff());
    packet.deferred = 0;
    packet.exit = packet.record = all(NO_HALF_FACE);
    packet.steps = Words{};
}

// The number of a pixel in its block, row after row.
LANE_FN uint number_in_block(const PacketJob& job, uint x, uint y)
{
    return (y - job.block_y) * tetrace::openmp::packet_block_size + x - job.block_x;
}

LANE_FN void make_rays(const PacketJob& job, uint x, uint y, Packet& packet)
{
    Ints column{}, row{};
    packet.lanes = 0;
    for (uint lane = 0; lane < LANES; ++lane) {
        const uint at_x = x + lane % packet_width, at_y = y + lane / packet_width;
        column[lane] = static_cast<int>(at_x);
        row[lane] = static_cast<int>(at_y);
        packet.numbers.of[lane] = number_in_block(job, at_x, at_y);
        if (at_x < job.width && at_y < job.height) packet.lanes |= 1u << lane;
    }
    make_rays_through(job, __builtin_convertvector(column, Floats), __builtin_convertvector(row, Floats), packet);
}

// For each axis, the lanes whose direction's largest component is along it.
struct ByAxis {
    uint of[3];
};
LANE_FN ByAxis by_deepest_axis(const Packet& packet)
{
    const Floats x = magnitude(packet.direction[0]), y = magnitude(packet.direction[1]),
                 z = magnitude(packet.direction[2]);
    const uint of_z = lanes_of(greater(z, x) & greater(z, y)), of_y = lanes_of(greater(y, x)) & ~of_z;
    return {{packet.lanes & ~of_y & ~of_z, packet.lanes & of_y, packet.lanes & of_z}};
}

LANE_FN Vectors offset_of(const Packet& packet, const Words* place)
{
    return {as_floats(place[0]) - packet.origin[0], as_floats(place[1]) - packet.origin[1],
            as_floats(place[2]) - packet.origin[2]};
}

// Where a lane sees a vertex.
struct Seen {
    Floats x, y;
};
LANE_FN Seen select(Mask mask, const Seen& a, const Seen& b)
{
    return {select(mask, a.x, b.x), select(mask, a.y, b.y)};
}
// shear_of() of project.h for rays whose deepest axis is z, without its products by zero: a point's x comes from its
// components along z and one other axis, and y likewise. If the kernel swaps x and y, this negates y, which gives the
// same products and the same signs.
template <int z>
struct Shear {
    static constexpr int x = (z + 1) % 3, y = (z + 2) % 3;
    Floats x_from_x, x_from_z, y_from_y, y_from_z;
};

template <int z>
LANE_FN Shear<z> shear_of(const Floats* direction)
{
    const Floats depth = direction[z] * all(0x1p20f);
    const Floats across = direction[Shear<z>::x] * all(-0x1p20f), upwards = direction[Shear<z>::y] * all(-0x1p20f);
    const Mask backwards = greater(Floats{}, direction[z]);
    return {depth, across, negated_where(backwards, depth), negated_where(backwards, upwards)};
}

template <int z>
LANE_FN Seen seen_at(const Packet& packet, const Shear<z>& shear, const Words* place)
{
    constexpr int x = Shear<z>::x, y = Shear<z>::y;
    const Floats along_x = as_floats(place[x]) - packet.origin[x];
    const Floats along_y = as_floats(place[y]) - packet.origin[y];
    const Floats along_z = as_floats(place[z]) - packet.origin[z];
    return {along_x * shear.x_from_x + along_z * shear.x_from_z, along_y * shear.y_from_y + along_z * shear.y_from_z};
}

// The same for lanes with different deepest axes: with the products by zero.
constexpr int any_axis = 3;
template <>
struct Shear<any_axis> {
    Vectors across, upwards;
};

template <>
LANE_FN Shear<any_axis> shear_of<any_axis>(const Floats* direction)
{
    const Floats x = magnitude(direction[0]), y = magnitude(direction[1]), z = magnitude(direction[2]), zero{};
    const Mask is_z = greater(z, x) & greater(z, y), is_y = without(greater(y, x), is_z);
    const auto by_axis = [&](Floats of_x, Floats of_y, Floats of_z) {
        return select(is_z, of_z, select(is_y, of_y, of_x));
    };
    const Floats deepest = by_axis(direction[0], direction[1], direction[2]);
    const Mask backwards = greater(zero, deepest);
    const Floats depth = deepest * all(0x1p20f), depth_up = negated_where(backwards, depth);
    const Floats across = by_axis(direction[1], direction[2], direction[0]) * all(-0x1p20f);
    const Floats upwards = negated_where(backwards, by_axis(direction[2], direction[0], direction[1]) * all(-0x1p20f));
    return {{by_axis(across, zero, depth), by_axis(depth, across, zero), by_axis(zero, depth, across)},
            {by_axis(upwards, depth_up, zero), by_axis(zero, upwards, depth_up), by_axis(depth_up, zero, upwards)}};
}

template <>
LANE_FN Seen seen_at<any_axis>(const Packet& packet, const Shear<any_axis>& shear, const Words* place)
{
    const Vectors offset = offset_of(packet, place);
    return {dot3(offset, shear.across), dot3(offset, shear.upwards)};
}

// A vertex for all lanes, the apex of a record.
template <int z>
LANE_FN Seen apex_seen(const PacketJob& job, const Packet& packet, const Shear<z>& shear, uint record)
{
    const uint* words = job.records + 4 * HALF32_QUADS * std::size_t{record};
    const Words place[3] = {all(words[0]), all(words[1]), all(words[2])};
    return seen_at(packet, shear, place);
}
// The depth of a vertex along the ray, as `along` in kernels/walks/carried.h, and the depth of the rays' ends.
LANE_FN Floats depth_at(const Packet& packet, const Words* place)
{
    return dot3(offset_of(packet, place), {packet.direction[0], packet.direction[1], packet.direction[2]});
}
LANE_FN Floats depth_of_end(const Packet& packet)
{
    const Vectors direction = {packet.direction[0], packet.direction[1], packet.direction[2]};
    return packet.end * dot3(direction, direction);
}

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
    const auto write = [&](uint lane) {
        const uint quarter = lane & ~3u;
        uint* const to = job.hits + HIT_WORDS * std::size_t{packet.numbers.of[lane]};
        __builtin_memcpy(to, &firsts[lane & 3u].of[quarter], 16);
        __builtin_memcpy(to + 4, &lasts[(lane >> 1) & 1u].of[quarter + 2 * (lane & 1u)], 8);
    };
    if (lanes == every_lane)
        for (uint lane = 0; lane < LANES; ++lane) // unrolled
            write(lane);
    else
        for (; lanes != 0; lanes &= lanes - 1)
            write(first_of(lanes));
}

// The hits of lanes whose rays have ended, or are left to the scalar kernel.
[[gnu::noinline, maybe_unused]] void write_hits(const PacketJob& job, Packet& packet, uint lanes)
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
