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

using tetrace::openmp::PacketJob;

#include "backends/openmp/packet/lanes.h"

#include "backends/openmp/packet/rays.h"

#include "backends/openmp/packet/walk.h"

#include "backends/openmp/packet/start.h"

#include "backends/openmp/packet/hits.h"

#include "backends/openmp/packet/shaft.h"

#include "backends/openmp/packet/beams.h"

#include "backends/openmp/packet/given.h"

constexpr uint packets_at_once = 4;

// Steps that packets do not count: the one out of the tet in which all rays start.
LANE_FN uint steps_before(const PacketJob& job)
{
    return job.start_tet == NO_TET ? 0 : 1;
}

// Lanes with one deepest axis, from several packets of a block; packets are given by their numbers.
template <int z, uint count>
[[gnu::noinline]] void trace_lanes(const PacketJob& job, const Packets& block, const uint* numbers, Packet* packets,
                                   const ByAxis* lanes)
{
    Walk<z> walks[count];
    for (uint i = 0; i < count; ++i) {
        walks[i].shear = shear_of<z>(packets[i].direction);
        walks[i].turn = walks[i].record = Words{};
        for (Seen& seen : walks[i].carried)
            seen = Seen{Floats{}, Floats{}};
        walks[i].live = 0;
        if (lanes[i].of[z] == 0) continue;
        if (block.record[numbers[i]] != NO_LINK)
            go_on_from(job, packets[i], walks[i], lanes[i].of[z], front_of(block, numbers[i]));
        else if (job.start_tet == NO_TET)
            enter_domain(job, packets[i], walks[i], lanes[i].of[z]);
        else
            leave_start(job, packets[i], walks[i], lanes[i].of[z]);
    }
    walk_on<z, count>(job, packets, walks, steps_before(job));
}

// Writes the hits of a packet; rays that took too many steps in a beam are left to the scalar kernel.
LANE_FN void write_counted_hits(const PacketJob& job, Packet& packet)
{
    const Words most = all(job.max_steps);
    packet.left_to_scalar |= ~lanes_of(equal(least(packet.steps, most), packet.steps));
    write_hits(job, packet, packet.lanes);
}

// Traces packets of a block, given by their numbers, from where their beams stopped.
template <uint count>
void trace_packets(const PacketJob& job, const Packets& block, const uint* numbers)
{
    Packet packets[count];
    ByAxis lanes[count];
    uint any[3] = {};
    for (uint i = 0; i < count; ++i) {
        const uint number = numbers[i];
        make_rays(job, block.x[number], block.y[number], packets[i]);
        if (block.record[number] != NO_LINK) packets[i].steps = all(block.steps[number] - steps_before(job));
        lanes[i] = by_deepest_axis(packets[i]);
        for (uint axis = 0; axis < 3; ++axis)
            any[axis] |= lanes[i].of[axis];
    }
    if (any[0] != 0) trace_lanes<0, count>(job, block, numbers, packets, lanes);
    if (any[1] != 0) trace_lanes<1, count>(job, block, numbers, packets, lanes);
    if (any[2] != 0) trace_lanes<2, count>(job, block, numbers, packets, lanes);
    if (count > 1)
        for (const Packet& packet : packets)
            prefetch_triangles(job, packet);
    for (Packet& packet : packets)
        write_counted_hits(job, packet);
}

// A packet whose beam has ended; most have left the domain, and need no rays for that.
void write_ended(const PacketJob& job, const Packets& block, uint number)
{
    const uint x_end = block.x[number] + packet_width, y_end = block.y[number] + packet_height;
    if (block.exit[number] == NO_LINK && block.steps[number] <= job.max_steps && x_end <= job.width &&
        y_end <= job.height) {
        write_misses(job, block.x[number], block.y[number], x_end, y_end, block.record[number] >> 2,
                     block.steps[number]);
        return;
    }
    Packet packet;
    make_rays(job, block.x[number], block.y[number], packet);
    packet.exit = all(block.exit[number]);
    packet.record = all(block.record[number]);
    packet.steps = all(block.steps[number]);
    write_counted_hits(job, packet);
}

// Prefetches the cache lines that a packet's hits are written to, while there is other work.
LANE_FN void prefetch_hits(const PacketJob& job, uint x, uint y)
{
    for (uint row = y; row < y + packet_height && row < job.height; ++row) {
        const uint* const to = job.hits + HIT_WORDS * (std::size_t{row} * job.width + x);
        __builtin_prefetch(to, 1);
        __builtin_prefetch(to + HIT_WORDS * packet_width - 1, 1);
    }
}

void trace_block(const PacketJob& job, Packets& block)
{
    walk_beams(job, block);
    uint waiting[packets_at_once], count = 0;
    for (uint i = 0; i < block.count; ++i) {
        if (block.has_ended[i]) {
            write_ended(job, block, i);
            continue;
        }
        prefetch_hits(job, block.x[i], block.y[i]);
        waiting[count++] = i;
        if (count < packets_at_once) continue;
        trace_packets<packets_at_once>(job, block, waiting);
        count = 0;
    }
    for (uint i = 0; i < count; ++i)
        trace_packets<1>(job, block, waiting + i);
}

// Collects the packets of a square of pixels by halving it down to squares of 8, without squares that see nothing of
// the domain. is_doubtful: false where all of its rays surely see the domain.
template <uint size>
void collect(const PacketJob& job, uint x, uint y, Packets& block, bool is_doubtful)
{
    if (x >= job.width || y >= job.height) return;
    const Square square = square_at(job, x, y, size);
    const Sight sight = is_doubtful ? sight_of(job, square) : Sight::all;
    if (sight == Sight::none) {
        write_misses(job, square.x, square.y, square.x_end, square.y_end, NO_TET, 0);
    } else if constexpr (size <= 8) {
        for (uint row = square.y; row < square.y_end; row += packet_height)
            for (uint column = square.x; column < square.x_end; column += packet_width) {
                block.x[block.count] = column;
                block.y[block.count++] = row;
            }
    } else {
        constexpr uint half = size / 2;
        for (uint i = 0; i < 4; ++i)
            collect<half>(job, x + i % 2 * half, y + i / 2 * half, block, sight == Sight::doubtful);
    }
}

} // namespace

#define JOINED(prefix, lanes) prefix##lanes
#define ENTRY_POINT(prefix, lanes) JOINED(prefix, lanes)

extern "C" void tetrace::openmp::ENTRY_POINT(tetrace_trace_rays_, LANES)(const PacketJob& job)
{
    if (job.has_ends)
        trace_rays<true>(job);
    else
        trace_rays<false>(job);
}

extern "C" void tetrace::openmp::ENTRY_POINT(tetrace_trace_block_, LANES)(const PacketJob& job, std::uint32_t x,
                                                                          std::uint32_t y)
{
    Packets block;
    block.count = 0;
    collect<tetrace::openmp::packet_block_size>(job, x, y, block, true);
    trace_block(job, block);
}
