// Traces a block of an image, or given rays, in packets of LANES rays: compiled once for each of 4, 8 and 16
// (CMakeLists.txt), the wider ones with instructions that not every processor has. Only the entry point may have
// external linkage, and no inline function of a library may be called: the linker keeps one copy of such a function for
// the whole program, and might keep the one compiled here.
#include "backends/openmp/packets.h"
#include "kernels/layouts/layout.h"

#include <cstddef>
#include <cstdint>
#if LANES > 4
#include <immintrin.h>
#endif

namespace {

using tetrace::openmp::Goal;
using tetrace::openmp::PacketJob;

#include "backends/openmp/packet/lanes.h"

#include "backends/openmp/packet/rays.h"

#include "backends/openmp/packet/walk.h"

#include "backends/openmp/packet/beams.h"

#include "backends/openmp/packet/places.h"

#include "backends/openmp/packet/crossing.h"

#include "backends/openmp/packet/given.h"

// Steps that packets do not count: the one out of the tet in which all rays start.
LANE_FN uint steps_before(const PacketJob& job)
{
    return job.start_tet == NO_TET ? 0 : 1;
}

// Packets that walk in turns. numbers: of the packets in their block.
struct Group {
    uint count;
    uint numbers[packets_in_turns];
    Packet packets[packets_in_turns];
    ByAxis lanes[packets_in_turns];
};

// The group's lanes with one deepest axis.
template <int z>
[[gnu::noinline]] void trace_lanes(const PacketJob& job, const Packets& block, Group& group)
{
    Walk<z> walks[packets_in_turns];
    Packet* const packets = group.packets;
    for (uint i = 0; i < group.count; ++i) {
        const uint lanes = group.lanes[i].of[z], number = group.numbers[i];
        walks[i].shear = shear_of<z>(packets[i].direction);
        walks[i].rotation = walks[i].record = Words{};
        for (Seen& seen : walks[i].carried)
            seen = Seen{Floats{}, Floats{}};
        walks[i].live = 0;
        if (lanes == 0) continue;
        if (block.record[number] != NO_HALF_FACE)
            go_on_from(job, packets[i], walks[i], lanes, front_of(block, number));
        else if (job.start_tet == NO_TET)
            enter_domain(job, packets[i], walks[i], lanes);
        else
            leave_start(job, packets[i], walks[i], lanes);
    }
    walk_on(job, packets, walks, group.count, steps_before(job));
}

// Writes the hits of a packet; rays that took too many steps in a beam are left to the scalar kernel.
LANE_FN void write_counted_hits(const PacketJob& job, Packet& packet)
{
    const Words most = all(job.max_steps);
    packet.deferred |= ~lanes_of(equal(least(packet.steps, most), packet.steps));
    write_hits(job, packet, packet.lanes);
}

// Traces a group's packets from where their beams stopped.
void trace_group(const PacketJob& job, const Packets& block, Group& group)
{
    uint any[3] = {};
    for (uint i = 0; i < group.count; ++i) {
        const uint number = group.numbers[i];
        Packet& packet = group.packets[i];
        make_rays(job, block.x[number], block.y[number], packet);
        if (block.record[number] != NO_HALF_FACE) packet.steps = all(block.steps[number] - steps_before(job));
        group.lanes[i] = by_deepest_axis(packet);
        for (uint axis = 0; axis < 3; ++axis)
            any[axis] |= group.lanes[i].of[axis];
    }
    if (any[0] != 0) trace_lanes<0>(job, block, group);
    if (any[1] != 0) trace_lanes<1>(job, block, group);
    if (any[2] != 0) trace_lanes<2>(job, block, group);
    for (uint i = 0; i < group.count; ++i)
        prefetch_triangles(job, group.packets[i]);
    for (uint i = 0; i < group.count; ++i)
        write_counted_hits(job, group.packets[i]);
    group.count = 0;
}

// A packet whose beam has ended; most have left the domain, and need no rays for that.
void write_ended(const PacketJob& job, const Packets& block, uint number)
{
    if (block.exit[number] == NO_HALF_FACE && block.steps[number] <= job.max_steps) {
        write_misses(job, block.x[number], block.y[number], block.record[number] >> 2, block.steps[number]);
        return;
    }
    Packet packet;
    make_rays(job, block.x[number], block.y[number], packet);
    packet.exit = all(block.exit[number]);
    packet.record = all(block.record[number]);
    packet.steps = all(block.steps[number]);
    write_counted_hits(job, packet);
}

void trace_block(const PacketJob& job, Packets& block)
{
    walk_beams(job, block);
    Group group;
    group.count = 0;
    for (uint i = 0; i < block.count; ++i) {
        if (block.has_ended[i]) {
            write_ended(job, block, i);
            continue;
        }
        group.numbers[group.count++] = i;
        if (group.count == packets_in_turns) trace_group(job, block, group);
    }
    trace_group(job, block, group);
}

// Collects the packets of a square of pixels by halving it down to squares of 8.
template <uint size>
void collect(const PacketJob& job, uint x, uint y, Packets& block)
{
    if constexpr (size <= 8) {
        for (uint row = y; row < y + size && row < job.height; row += packet_height)
            for (uint column = x; column < x + size && column < job.width; column += packet_width) {
                block.x[block.count] = column;
                block.y[block.count++] = row;
            }
    } else {
        constexpr uint half = size / 2;
        for (uint i = 0; i < 4; ++i)
            collect<half>(job, x + i % 2 * half, y + i / 2 * half, block);
    }
}

} // namespace

#define JOINED(prefix, lanes) prefix##lanes
#define ENTRY_POINT(prefix, lanes) JOINED(prefix, lanes)

extern "C" void tetrace::openmp::ENTRY_POINT(tetrace_trace_rays_, LANES)(const PacketJob& job)
{
    switch (job.goal) {
    case Goal::triangle: trace_rays<Goal::triangle>(job); break;
    case Goal::end: trace_rays<Goal::end>(job); break;
    case Goal::boundary: trace_rays<Goal::boundary>(job); break;
    }
}

extern "C" void tetrace::openmp::ENTRY_POINT(tetrace_trace_block_, LANES)(const PacketJob& job)
{
    Packets block;
    block.count = 0;
    collect<tetrace::openmp::packet_block_size>(job, job.block_x, job.block_y, block);
    trace_block(job, block);
}
