// packet/: the walk of a packet of rays, a ray per lane; one source for vectors of 4, 8 and 16 lanes.
#pragma once

// Vectors in double precision, for what is computed once per view.
struct Double3 {
    double x, y, z;
};
LANE_FN Double3 double3_of(const float* a)
{
    return {a[0], a[1], a[2]};
}
LANE_FN Double3 scaled(Double3 a, double factor)
{
    return {a.x * factor, a.y * factor, a.z * factor};
}
LANE_FN double dot(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LANE_FN Double3 cross(Double3 a, Double3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LANE_FN double size_of(Double3 a)
{
    return __builtin_fabs(a.x) + __builtin_fabs(a.y) + __builtin_fabs(a.z);
}

// Beams: steps that all rays of a packet take alike are done once, for the beam of all directions that its pixels span.
// Each lane is the beam of one packet. A beam goes on while all its rays are sure to have the same answer in spite of
// rounding (docs/spec/packets.md, K7).
constexpr uint max_packets = tetrace::openmp::packet_block_size * tetrace::openmp::packet_block_size / LANES;
constexpr uint batches_in_turns = 4;
constexpr float reach_x = 0.5f * (packet_width - 1); // from the middle of a beam to its outermost rays, in pixels
constexpr float reach_y = 0.5f * (packet_height - 1);

// The packets of a block, and how far their beams have come.
struct Packets {
    uint count;
    uint x[max_packets], y[max_packets]; // first pixels
    uint record[max_packets];     // the record in front of which all rays are, or in whose tet they ended; NO_HALF_FACE
                                  // where they share no way: some may be in the domain
    uint carried[3][max_packets]; // of those in front of a record, see Front
    uint rotation[max_packets];   // of those too
    uint exit[max_packets];       // of those that have ended
    uint steps[max_packets];      // tets left
    bool has_ended[max_packets];
};

// The image's own coordinates. A point relative to the rays' origin is its depth times the direction of the pixel where
// it is seen; `rows` transform it into that pixel times the depth, and the depth. A side of an edge is certain if it
// exceeds the error bounds of the edge's ends: `doubt` times their distance from the middle, plus `min_doubt`.
struct Eye {
    Vectors rows[3];
    Floats sense; // -1: columns are counted backwards, so that left in space is left here
    Floats doubt, min_doubt;
};

LANE_FN double greatest_of(Double3 a)
{
    return __builtin_fmax(__builtin_fmax(__builtin_fabs(a.x), __builtin_fabs(a.y)), __builtin_fabs(a.z));
}

LANE_FN Eye eye_of(const PacketJob& job)
{
    const Double3 across = double3_of(job.step_x), upwards = double3_of(job.step_y), first = double3_of(job.corner);
    const Double3 normals[3] = {cross(upwards, first), cross(first, across), cross(across, upwards)};
    const double scale = 1 / dot(across, normals[0]), volume = __builtin_fabs(scale);
    Eye eye;
    const Double3 rows[3] = {scaled(normals[0], volume), scaled(normals[1], scale), scaled(normals[2], scale)};
    double distance = 0, extent = 0;
    for (uint i = 0; i < 3; ++i) {
        eye.rows[i] = {all(static_cast<float>(rows[i].x)), all(static_cast<float>(rows[i].y)),
                       all(static_cast<float>(rows[i].z))};
        const float* const planes = job.lines + i * (job.divisions + 1);
        distance += __builtin_fmax(__builtin_fabs(planes[0] - job.origin[i]),
                                   __builtin_fabs(planes[job.divisions] - job.origin[i]));
        extent = __builtin_fmax(extent, __builtin_fabs(job.corner[i]) + job.width * __builtin_fabs(job.step_x[i]) +
                                            job.height * __builtin_fabs(job.step_y[i]));
    }
    eye.sense = all(scale < 0 ? -1.0f : 1.0f);
    const double depth = greatest_of(rows[2]);
    const double pixels =
        __builtin_fmax(greatest_of(rows[0]) + job.width * depth, greatest_of(rows[1]) + job.height * depth);
    const double step = __builtin_fmax(greatest_of(across), greatest_of(upwards));
    const double relative = 0x1p-19 * distance * (pixels + step * (extent + 2) * volume);
    const double least = relative * distance * (8 * depth + 0x1p-20 * (extent + 4) * size_of(rows[2]) / step);
    const bool is_usable = size_of(across) * size_of(upwards) * size_of(first) * volume < 0x1p16 &&
                           relative > 0x1p-60 && least > 0x1p-60 && least < 0x1p60;
    eye.doubt = all(static_cast<float>(relative));
    eye.min_doubt = all(is_usable ? static_cast<float>(least) : __builtin_inff());
    return eye;
}

// Where beams see a vertex: columns and rows relative to the beam's middle, times its depth.
struct Imaged {
    Floats column, row, depth, doubt;
};
LANE_FN Imaged select(Mask mask, const Imaged& a, const Imaged& b)
{
    return {select(mask, a.column, b.column), select(mask, a.row, b.row), select(mask, a.depth, b.depth),
            select(mask, a.doubt, b.doubt)};
}

// LANES beams during their walk.
struct BeamWalk : WalkState {
    Imaged carried[3];
    Words apexes[3];    // the records whose apexes the carried vertices are
    Floats column, row; // of their middle
    Words exit, steps;
    uint begun, ended;
};

LANE_FN Imaged imaged(const PacketJob& job, const Eye& eye, const BeamWalk& walk, const Words* place)
{
    const Vectors at = {as_floats(place[0]) - all(job.origin[0]), as_floats(place[1]) - all(job.origin[1]),
                        as_floats(place[2]) - all(job.origin[2])};
    const auto along = [&](const Vectors& row, Floats from) {
        return fused(at.x, row.x, fused(at.y, row.y, fused(at.z, row.z, from)));
    };
    const Floats depth = along(eye.rows[2], Floats{});
    const Floats column = along(eye.rows[0], -(walk.column * depth)), row = along(eye.rows[1], -(walk.row * depth));
    return {column, row, depth, fused(magnitude(column) + magnitude(row), eye.doubt, eye.min_doubt)};
}

// Masks of the beams all of whose rays see q to the left of p, and of those all of whose rays see it to the right.
struct SureSides {
    Mask left, right;
};
LANE_FN SureSides sure_sides(const Imaged& p, const Imaged& q)
{
    const auto crossed = [](Floats a, Floats b, Floats c, Floats d) { return fused(a, b, -(c * d)); };
    const Floats side = crossed(p.column, q.row, p.row, q.column);
    const Floats by_column = magnitude(crossed(p.row, q.depth, p.depth, q.row)),
                 by_row = magnitude(crossed(p.depth, q.column, p.column, q.depth));
    const Floats spread = fused(by_column, all(reach_x), fused(by_row, all(reach_y), p.doubt + q.doubt));
    return {greater(side, spread), greater(-spread, side)};
}

// The corners of the faces that lanes' half-faces name.
LANE_FN void see_corners(const PacketJob& job, const Eye& eye, const BeamWalk& walk, Words half_faces, Imaged* corners)
{
    for (uint i = 0; i < 3; ++i)
        corners[i] = imaged(job, eye, walk, corners_of(job, half_faces, i).of);
}

// Lets beams enter tets by faces; the beams then carry the corners of these faces.
LANE_FN void enter_tets_by(BeamWalk& walk, Mask lanes, Words half_faces, const Imaged* corners)
{
    for (uint i = 0; i < 3; ++i) {
        walk.carried[i] = select(lanes, corners[i], walk.carried[i]);
        walk.apexes[i] = select(lanes, record_of_corner(half_faces, i), walk.apexes[i]);
    }
    walk.record = select(lanes, half_faces, walk.record);
    walk.live |= lanes_of(lanes);
}

// Lets beams enter the domain by a face by which all their rays enter.
LANE_FN void enter_domain(const PacketJob& job, const Eye& eye, BeamWalk& walk, uint lanes)
{
    Packet middle;
    make_rays_through(job, walk.column * eye.sense, walk.row, middle);
    const Words squares = entry_squares(job, middle);
    lanes &= ~lanes_of(equal(squares, all(6 * job.divisions * job.divisions)));
    test_faces(job, squares, lanes, [&](Words half_faces, uint asking) {
        Imaged corners[3];
        see_corners(job, eye, walk, half_faces, corners);
        const Mask entering = mask_of(asking) & sure_sides(corners[0], corners[1]).left &
                              sure_sides(corners[1], corners[2]).left & sure_sides(corners[2], corners[0]).left;
        enter_tets_by(walk, entering, half_faces, corners);
        return lanes_of(entering);
    });
}

// Lets beams leave the tet that they start in by a face by which all their rays leave.
LANE_FN void leave_start(const PacketJob& job, const Eye& eye, BeamWalk& walk, uint lanes)
{
    for (uint face = 0; face < 4; ++face) {
        Imaged corners[3];
        see_corners(job, eye, walk, all(job.start_tet << 2 | face), corners);
        const Mask leaving = mask_of(lanes) & sure_sides(corners[0], corners[1]).right &
                             sure_sides(corners[1], corners[2]).right & sure_sides(corners[2], corners[0]).right;
        if (lanes_of(leaving) == 0) continue;
        walk.steps = select(leaving, all(1u), walk.steps);
        const uint exit = exit_through(job, job.start_tet, face);
        if ((exit & 3u) == EXIT_END) {
            walk.exit = select(leaving, all(exit), walk.exit);
            walk.record = select(leaving, all(job.start_tet << 2), walk.record);
            walk.ended |= lanes_of(leaving);
        } else {
            see_corners(job, eye, walk, all(exit >> 2), corners);
            enter_tets_by(walk, leaving, all(exit >> 2), corners);
        }
    }
}

// A step of all live beams.
LANE_FN void step(const PacketJob& job, const Eye& eye, BeamWalk& walk)
{
    const Records at = load_records(job.records, walk.offsets);
    const Imaged apex = imaged(job, eye, walk, at.apex.of);
    const SureSides s0 = sure_sides(walk.carried[0], apex), s1 = sure_sides(walk.carried[1], apex),
                    s2 = sure_sides(walk.carried[2], apex);
    const Mask replaced[3] = {s2.left & s1.right, s0.left & s2.right, s1.left & s0.right};
    const uint going = walk.live & lanes_of(replaced[0] | replaced[1] | replaced[2]);
    for (uint i = 0; i < 3; ++i) {
        walk.carried[i] = select(replaced[i], apex, walk.carried[i]);
        walk.apexes[i] = select(replaced[i], walk.record, walk.apexes[i]);
    }
    walk.steps = select(mask_of(going), walk.steps + all(1u), walk.steps);
    const Words rotation = walk.rotation;
    const Words exits = exits_of(walk, replaced, at.exits.of);
    walk.rotation = select(mask_of(going), walk.rotation, rotation); // beams that stop here keep their vertices
    const uint ended = going & lanes_of(equal(exits & all(3u), all(EXIT_END)));
    walk.exit = select(mask_of(ended), exits, walk.exit);
    walk.ended |= ended;
    go_on(walk, mask_of(going & ~ended), exits);
}

// Sets the lanes to the beams of packets [first, first + LANES) of a block, and returns the mask of those that exist.
LANE_FN uint aim(const Eye& eye, const Packets& packets, uint first, BeamWalk& walk)
{
    const uint count = packets.count - first < LANES ? packets.count - first : LANES;
    Ints columns{}, rows{};
    for (uint lane = 0; lane < count; ++lane) {
        columns[lane] = static_cast<int>(packets.x[first + lane]);
        rows[lane] = static_cast<int>(packets.y[first + lane]);
    }
    walk.column = (__builtin_convertvector(columns, Floats) + all(reach_x)) * eye.sense;
    walk.row = __builtin_convertvector(rows, Floats) + all(reach_y);
    return count < LANES ? (1u << count) - 1u : every_lane;
}

// The beams of packets [first, first + LANES) of a block at their start.
[[gnu::noinline]] void begin(const PacketJob& job, const Eye& eye, const Packets& packets, uint first, BeamWalk& walk)
{
    const uint lanes = aim(eye, packets, first, walk);
    walk.rotation = walk.record = walk.steps = Words{};
    for (Words& apex : walk.apexes)
        apex = Words{};
    walk.exit = all(NO_HALF_FACE);
    for (Imaged& vertex : walk.carried)
        vertex = Imaged{Floats{}, Floats{}, Floats{}, Floats{}};
    walk.live = walk.ended = 0;
    if (job.start_tet == NO_TET)
        enter_domain(job, eye, walk, lanes);
    else
        leave_start(job, eye, walk, lanes);
    walk.begun = walk.live | walk.ended;
    store(walk.offsets, walk.record * (4 * HALF32_QUADS));
}

LANE_FN void end(Packets& packets, uint first, const BeamWalk& walk)
{
    LaneWords record, carried[3], rotation, exit, steps;
    store(record, select(mask_of(walk.begun), walk.record, all(NO_HALF_FACE)));
    for (uint i = 0; i < 3; ++i)
        store(carried[i], walk.apexes[i]);
    store(rotation, walk.rotation);
    store(exit, walk.exit);
    store(steps, walk.steps);
    for (uint lane = 0; lane < LANES && first + lane < packets.count; ++lane) {
        const uint number = first + lane;
        packets.record[number] = record.of[lane];
        for (uint i = 0; i < 3; ++i)
            packets.carried[i][number] = carried[i].of[lane];
        packets.rotation[number] = rotation.of[lane];
        packets.exit[number] = exit.of[lane];
        packets.steps[number] = steps.of[lane];
        packets.has_ended[number] = (walk.ended >> lane & 1u) != 0;
    }
}

// Where a packet continues after its beam has stopped in front of a record.
LANE_FN Front front_of(const Packets& packets, uint number)
{
    const auto& carried = packets.carried;
    return {
        packets.record[number], {carried[0][number], carried[1][number], carried[2][number]}, packets.rotation[number]};
}

// Walks the beams of a block's packets as far as they can go.
void walk_beams(const PacketJob& job, Packets& packets)
{
    constexpr uint few = LANES / 8; // the last few beams would save less than a step costs
    const Eye eye = eye_of(job);
    for (uint first = 0; first < packets.count; first += batches_in_turns * LANES) {
        BeamWalk walks[batches_in_turns];
        uint batches = 0;
        for (; batches < batches_in_turns && first + batches * LANES < packets.count; ++batches)
            begin(job, eye, packets, first + batches * LANES, walks[batches]);
        bool goes_on = true;
        for (uint steps = 0; goes_on && steps < job.max_steps; ++steps) {
            goes_on = false;
            for (uint i = 0; i < batches; ++i) {
                if (static_cast<uint>(__builtin_popcount(walks[i].live)) <= few) continue;
                step(job, eye, walks[i]);
                goes_on = true;
            }
        }
        for (uint i = 0; i < batches; ++i)
            end(packets, first + i * LANES, walks[i]);
    }
}
