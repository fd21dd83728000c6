// The rays of a packet, a lane each: LANES neighbouring pixels, 4 x 4, 4 x 2 or 2 x 2. As ray.h and shear.h have them,
// operation for operation. After lanes.h.
constexpr uint packet_width = LANES == 4 ? 2 : 4;
constexpr uint packet_height = LANES / packet_width;

struct Vectors {
    Floats x, y, z;
};
LANE_FN Vectors sub3(const Vectors& a, const Vectors& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
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
    uint x, y; // its first pixel
    Floats direction[3];
    uint lanes;          // that are in the image
    uint left_to_scalar; // those whose sign is a tie, or that do what hardly any ray does
    // How a ray has ended: the exit's word, the record of the tet that it left last, tets left.
    Words exit, record, steps;
};

LANE_FN void make_rays(const PacketJob& job, uint x, uint y, Packet& packet)
{
    Ints column{}, row{};
    packet.x = x;
    packet.y = y;
    packet.lanes = 0;
    for (uint lane = 0; lane < LANES; lane++) {
        const uint at_x = x + lane % packet_width, at_y = y + lane / packet_width;
        column[lane] = static_cast<int>(at_x);
        row[lane] = static_cast<int>(at_y);
        if (at_x < job.width && at_y < job.height) packet.lanes |= 1u << lane;
    }
    const Floats px = __builtin_convertvector(column, Floats), py = __builtin_convertvector(row, Floats);
    for (uint axis = 0; axis < 3; axis++) {
        const Floats d = all(job.corner[axis]) + all(job.step_x[axis]) * px + all(job.step_y[axis]) * py;
        packet.direction[axis] = select(greater(all(0x1p-20f), magnitude(d)), Floats{}, d);
    }
    packet.left_to_scalar = 0;
    packet.exit = packet.record = all(NO_LINK);
    packet.steps = Words{};
}

// The lanes whose direction is longest along each axis.
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

// Where a lane sees a vertex.
struct Seen {
    Floats x, y;
};
// shear_of() of project.h for rays whose deepest axis is z, without its products by zero: a point's x is that of its
// components along the axes behind z and z with two numbers, and y likewise. Where the kernel has x and y change places
// this has y negated, which makes the same products and the same signs.
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
LANE_FN Seen seen_at(const PacketJob& job, const Shear<z>& shear, const Words* place)
{
    constexpr int x = Shear<z>::x, y = Shear<z>::y;
    const Floats along_x = as_floats(place[x]) - all(job.origin[x]);
    const Floats along_y = as_floats(place[y]) - all(job.origin[y]);
    const Floats along_z = as_floats(place[z]) - all(job.origin[z]);
    return {along_x * shear.x_from_x + along_z * shear.x_from_z, along_y * shear.y_from_y + along_z * shear.y_from_z};
}
// A vertex for all lanes, the apex of a record.
template <int z>
LANE_FN Seen apex_seen(const PacketJob& job, const Shear<z>& shear, uint record)
{
    const uint* words = job.records + 4 * HALF32_ROWS * std::size_t{record};
    const Words place[3] = {all(words[0]), all(words[1]), all(words[2])};
    return seen_at(job, shear, place);
}
